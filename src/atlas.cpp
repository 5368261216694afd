// SPDX-License-Identifier: MIT
#include <taut/impl/atlas/make_atlas.ipp>
#include <taut/impl/atlas/segment.ipp>
#include <taut/impl/atlas/symmetry/find_symmetry.ipp>
