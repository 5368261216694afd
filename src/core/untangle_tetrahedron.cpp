// SPDX-License-Identifier: MIT
#include <taut/impl/core/untangle/untangle_tetrahedron.ipp>
