// SPDX-License-Identifier: MIT
#include <taut/repair/detail/repair_surface.ipp>
