// SPDX-License-Identifier: MIT
#pragma once

/// Content of volume files: cells of all kinds, groups, and their adjacency.
#include <taut/impl/io/cell_faces.hpp>
#include <taut/impl/io/read_volume.hpp>
#include <taut/impl/io/volume_file.hpp>
#include <taut/impl/io/write_volume.hpp>
