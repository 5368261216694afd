// SPDX-License-Identifier: MIT
#include <taut/impl/charts/repair/repair_surface.ipp>
