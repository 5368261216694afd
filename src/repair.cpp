// SPDX-License-Identifier: MIT
#include <taut/impl/repair/repair_surface.ipp>
