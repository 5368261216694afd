// SPDX-License-Identifier: MIT
#include <taut/impl/untangle/untangle_triangle.ipp>
