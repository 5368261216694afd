// SPDX-License-Identifier: MIT
#include <taut/impl/packing/pack.ipp>
