// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <set>

#include <support/meshes.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A tetrahedron's surface, closed.
mesh<triangle> tetrahedron_surface()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}};
}

void check_charts(const mesh<triangle>& m, const chart_mesh& charts)
{
    CHECK(charts.first_cell.back() == m.cell_count());
    CHECK(charts.first_vertex.back() == charts.surface.vertex_count());
    for (idx k = 0; k < charts.charts(); ++k)
        for (auto c = static_cast<std::size_t>(charts.first_cell[static_cast<std::size_t>(k)]);
             c < static_cast<std::size_t>(charts.first_cell[static_cast<std::size_t>(k) + 1]); ++c)
            for (std::size_t j = 0; j < 3; ++j)
            {
                const idx v = charts.surface.cells()[c][j];
                CHECK(charts.first_vertex[static_cast<std::size_t>(k)] <= v);
                CHECK(v < charts.first_vertex[static_cast<std::size_t>(k) + 1]);
                const idx origin = charts.vertex_origins[static_cast<std::size_t>(v)];
                CHECK(origin == m.cells()[static_cast<std::size_t>(charts.cell_origins[c])][j]);
            }
}

} // namespace

TEST_CASE("chart_mesh: a surface without seams is one chart, as it was")
{
    const auto m = tetrahedron_surface();
    const auto f = facets(m);
    const auto charts = cut_charts(m, f, std::vector<char>(f.twin.size(), 0));
    CHECK(charts.charts() == 1);
    CHECK(charts.surface.cells() == m.cells());
    CHECK(charts.surface.points() == m.points());
    check_charts(m, charts);
}

TEST_CASE("chart_mesh: labels part a surface, and each chart has its own vertices")
{
    const auto m = tetrahedron_surface();
    const auto f = facets(m);
    const std::vector<idx> labels = {5, 2, 2, 5};
    const auto charts = cut_charts(m, f, seams_between(f, labels));
    CHECK(charts.charts() == 2);
    CHECK(charts.first_cell == std::vector<idx>{0, 2, 4});
    CHECK(charts.cell_origins == std::vector<idx>{0, 3, 1, 2});
    CHECK(charts.first_vertex == std::vector<idx>{0, 4, 8});
    check_charts(m, charts);
}

TEST_CASE("chart_mesh: a seam within a chart doubles the vertices along it, but for its ends")
{
    const auto m = tetrahedron_surface();
    const auto f = facets(m);
    std::vector<char> seam(f.twin.size(), 0);
    // The three edges at vertex 3: the surface opens like a flower.
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        seam[s] = a == 3 || b == 3;
    }
    const auto charts = cut_charts(m, f, seam);
    CHECK(charts.charts() == 1);
    CHECK(charts.surface.vertex_count() == 6);
    check_charts(m, charts);
    // One edge alone has both ends in common: nothing is doubled.
    std::fill(seam.begin(), seam.end(), char(0));
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        seam[s] = (a == 3 && b == 0) || (a == 0 && b == 3);
    }
    CHECK(cut_charts(m, f, seam).surface.vertex_count() == 4);
}
