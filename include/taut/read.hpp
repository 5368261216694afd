// SPDX-License-Identifier: MIT
#pragma once

/// Reads surfaces, volumes, pins and problems.
#include <taut/impl/io/cell_faces.hpp>
#include <taut/impl/io/cut_seams.hpp>
#include <taut/impl/io/pins.hpp>
#include <taut/impl/io/prob.hpp>
#include <taut/impl/io/read_surface.hpp>
#include <taut/impl/io/read_volume.hpp>
#include <taut/impl/io/write_obj.hpp>
#include <taut/impl/io/write_volume.hpp>
