// SPDX-License-Identifier: MIT
#include <taut/impl/bake/bake.ipp>
