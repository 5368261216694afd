// SPDX-License-Identifier: MIT
#include <taut/untangle/detail/untangle_triangle.ipp>
