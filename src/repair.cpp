// SPDX-License-Identifier: MIT
// The body of repair/ for the compiled form.
#include <taut/repair/detail/repair_surface.ipp>
