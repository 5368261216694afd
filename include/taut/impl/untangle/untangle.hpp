// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/untangle/untangle_declared.hpp>

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/untangle/untangle_tetrahedron.ipp>
#include <taut/impl/untangle/untangle_triangle.ipp>
#endif
