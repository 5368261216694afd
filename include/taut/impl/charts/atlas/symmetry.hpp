// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/charts.hpp>
#include <taut/impl/core/mesh/facets.hpp>

namespace taut::impl
{

/// find_symmetry() of a surface whose facets are f.
mirror_symmetry find_symmetry(const mesh<triangle>& m, const facet_table& f, std::span<const char> together = {},
                              double tolerance = 1e-4);

} // namespace taut::impl
