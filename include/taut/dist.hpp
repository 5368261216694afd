// SPDX-License-Identifier: MIT
#pragma once

/// Deformations of one mesh over many processes. Needs MPI and PETSc: CMake's taut::dist links them, and taut.hpp
/// includes none of it.
#include <taut/impl/dist/check.hpp>
#include <taut/impl/dist/session.hpp>
#include <taut/impl/dist/smooth.hpp>
#include <taut/impl/dist/volume_pieces.hpp>
#include <taut/impl/processes/remote_error.hpp>
