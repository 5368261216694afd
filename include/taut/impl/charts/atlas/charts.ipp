// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/cut_to_disk.hpp>
#include <taut/impl/charts/atlas/symmetry.hpp>
#include <taut/impl/core/mesh/facets.hpp>

namespace taut
{

chart_mesh cut_charts(const mesh<triangle>& m, std::span<const char> seam)
{
    return impl::cut_charts(m, impl::facets(m), seam);
}


std::vector<char> cut_to_disk(const mesh<triangle>& m)
{
    return impl::cut_to_disk(m, impl::facets(m));
}


mirror_symmetry find_symmetry(const mesh<triangle>& m, std::span<const char> together, double tolerance)
{
    return impl::find_symmetry(m, impl::facets(m), together, tolerance);
}

} // namespace taut
