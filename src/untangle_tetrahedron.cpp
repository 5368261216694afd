// SPDX-License-Identifier: MIT
#include <taut/untangle/detail/untangle_tetrahedron.ipp>
