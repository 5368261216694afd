// SPDX-License-Identifier: MIT
#pragma once

/// Writes maps, surfaces and volumes, several files together or none.
#include <taut/impl/io/cut_seams.hpp>
#include <taut/impl/io/pins.hpp>
#include <taut/impl/io/write_files.hpp>
#include <taut/impl/io/write_map.hpp>
#include <taut/impl/io/write_obj.hpp>
#include <taut/impl/io/write_volume.hpp>
