// SPDX-License-Identifier: MIT
#include <taut/atlas.hpp>
#include <taut/pack.hpp>
#include <taut/queue.hpp>

#include <vector>

#include <doctest/doctest.h>

#include <support/closed_meshes.hpp>

namespace
{

/// One flag per side: the edges of every triangle.
std::vector<char> all_edges(const taut::mesh<taut::triangle>& m)
{
    return std::vector<char>(3 * m.cells().size(), 1);
}

} // namespace

TEST_CASE("parts of an atlas: a program cuts, flattens, packs and certifies by public names alone")
{
    taut::queue queue;
    const auto mesh = taut::test::ball(8);
    // [parts]
    const auto cut = taut::segment(mesh, [&](const taut::chart_mesh& c) { return taut::flatten_charts(queue, c); });
    const auto& charts = cut.charts;

    const taut::pack_params page{.resolution = 512, .padding = 4};
    const auto packed = taut::pack(cut.uv, charts.surface.cells(), charts.first_cell, charts.first_vertex, page);
    const auto uv = packed.apply(cut.uv, charts.first_vertex);
    const auto proof = taut::certify_packing(uv, charts.surface.cells(), charts.first_cell, charts.first_vertex);
    // [parts]
    CHECK(charts.charts() >= 2);
    CHECK(cut.report.unmapped == 0);
    CHECK(proof.holds(page.padding, page.resolution));
}

TEST_CASE("parts of an atlas: seams along all edges leave each triangle by itself, those of one disk one chart")
{
    const auto mesh = taut::test::ball(3);
    CHECK(taut::cut_charts(mesh, all_edges(mesh)).charts() == mesh.cell_count());
    const auto disk = taut::cut_charts(mesh, taut::cut_to_disk(mesh));
    CHECK(disk.charts() == 1);
    CHECK(taut::boundary_loops(disk.surface).size() == 1);
    CHECK(taut::find_symmetry(mesh).vertex.size() == mesh.points().size());
}
