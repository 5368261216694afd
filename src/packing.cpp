// SPDX-License-Identifier: MIT
#include <taut/packing/detail/pack.ipp>
