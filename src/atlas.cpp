// SPDX-License-Identifier: MIT
// The bodies of atlas/, but for flatten_charts(), for the compiled form.
#include <taut/atlas/make_atlas.hpp>
#include <taut/atlas/symmetry.hpp>

#include <taut/atlas/detail/make_atlas.ipp>
#include <taut/atlas/detail/segment.ipp>
#include <taut/atlas/detail/symmetry/find_symmetry.ipp>
