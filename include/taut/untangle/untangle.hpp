// SPDX-License-Identifier: MIT
#pragma once

#include <taut/untangle/detail/untangle_declared.hpp>

#ifdef TAUT_IMPLEMENTATION
#include <taut/untangle/detail/untangle_tetrahedron.ipp>
#include <taut/untangle/detail/untangle_triangle.ipp>
#endif
