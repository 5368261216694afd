// SPDX-License-Identifier: MIT
#pragma once

/// The errors that calls throw: all derive from `error`, and carry what they are about.
#include <taut/impl/atlas/symmetry.hpp>
#include <taut/impl/compute/errors.hpp>
#include <taut/impl/constrain/constraint_error.hpp>
#include <taut/impl/core/error.hpp>
#include <taut/impl/edit/paste_error.hpp>
#include <taut/impl/edit/rbf_error.hpp>
#include <taut/impl/edit/region_error.hpp>
#include <taut/impl/io/io_error.hpp>
#include <taut/impl/mesh/mesh_error.hpp>
#include <taut/impl/packing/packing_error.hpp>
#include <taut/impl/repair/repair_finding.hpp>
