// SPDX-License-Identifier: MIT
// The bodies of packing/ for the compiled form.
#include <taut/packing/detail/pack.ipp>
