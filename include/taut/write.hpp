// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_VOLUME_FILE
#endif
#ifndef TAUT_WRITE_HPP
#define TAUT_WRITE_HPP

/// Writes maps, surfaces and volumes, several files together or none.
#include <taut/files.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#endif
#include <taut/impl/leave.inl>
