// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_VOLUME_FILE
#endif
#ifndef TAUT_READ_HPP
#define TAUT_READ_HPP

/// Reads surfaces, volumes, pins and problems.
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#endif
#include <taut/impl/leave.inl>
