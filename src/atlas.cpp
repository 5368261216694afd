// SPDX-License-Identifier: MIT
#include <taut/atlas/detail/make_atlas.ipp>
#include <taut/atlas/detail/segment.ipp>
#include <taut/atlas/detail/symmetry/find_symmetry.ipp>
