// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <span>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

namespace taut::test
{

/// One chart as a mesh of its own.
inline mesh<triangle> chart(const chart_mesh& charts, idx k)
{
    const auto i = static_cast<std::size_t>(k);
    const auto part = [](const auto& all, idx first, idx last)
    { return std::vector(all.begin() + first, all.begin() + last); };
    auto cells = part(charts.surface.cells(), charts.first_cell[i], charts.first_cell[i + 1]);
    for (auto& t : cells)
        for (idx& v : t) v -= charts.first_vertex[i];
    return {part(charts.surface.points(), charts.first_vertex[i], charts.first_vertex[i + 1]), std::move(cells)};
}

/// Every chart that these seams make must be a disk, with holes or without. Returns their number.
inline idx check_flattenable(const mesh<triangle>& m, const impl::facet_table& f, std::span<const char> seam)
{
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (f.twin[s] >= 0 && seam[s] != seam[static_cast<std::size_t>(f.twin[s])]) FAIL("a seam has one side");
    const auto charts = cut_charts(m, f, seam);
    for (idx k = 0; k < charts.charts(); ++k)
    {
        const auto one = chart(charts, k);
        const auto faults = check(one, impl::facets(one), {.one_boundary = false});
        if (!faults.empty()) FAIL("chart " << k << ": " << faults.front().message);
    }
    return charts.charts();
}

} // namespace taut::test
