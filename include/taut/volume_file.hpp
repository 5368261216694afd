// SPDX-License-Identifier: MIT
#pragma once

/// What a volume file holds: cells of all kinds, groups, and what lies between.
#include <taut/impl/io/cell_faces.hpp>
#include <taut/impl/io/read_volume.hpp>
#include <taut/impl/io/volume_file.hpp>
#include <taut/impl/io/write_volume.hpp>
