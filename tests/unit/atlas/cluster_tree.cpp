// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include <support/chart_checks.hpp>
#include <support/closed_meshes.hpp>
#include <support/meshes.hpp>
#include <taut/impl/charts/atlas/cluster_tree.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// The charts after the first `merges` steps.
std::vector<char> seams_after(const cluster_tree& tree, const facet_table& f, idx merges)
{
    std::vector<char> chosen(static_cast<std::size_t>(tree.nodes()), 0);
    for (idx n = 0; n < tree.leaves + merges; ++n)
    {
        const idx parent = tree.parents[static_cast<std::size_t>(n)];
        chosen[static_cast<std::size_t>(n)] = parent == cluster_tree::none || parent >= tree.leaves + merges;
    }
    return tree.seams(f, tree.labels(chosen));
}

void check_every_cut(const mesh<triangle>& m)
{
    const auto f = facets(m);
    const auto tree = make_cluster_tree(m, f);
    const auto merges = static_cast<idx>(tree.children.size());
    idx before = m.cell_count() + 1;
    for (const idx left : {merges, merges / 2, merges / 8, merges / 32, std::min(merges / 32, 1), 0})
    {
        const idx made = merges - left;
        const idx charts = test::check_flattenable(m, f, seams_after(tree, f, made));
        CHECK(charts <= before);
        before = charts;
    }
}

} // namespace

TEST_CASE("cluster_tree: all that it makes can be flattened, whatever the surface is")
{
    check_every_cut(test::octahedron());
    check_every_cut(test::bumpy(24));
    check_every_cut(test::torus(8, false));
    check_every_cut(test::torus(8, true));
    check_every_cut(test::annulus(16));
    check_every_cut(test::tube(24, 4.0));
    check_every_cut(test::two_components());
    check_every_cut(test::single_triangle());
    check_every_cut(test::box(6));
    check_every_cut(test::noisy(test::ball(6), 0.05));
    check_every_cut(test::pierced_plate(3, 2));
    const auto plate = test::pierced_plate(2, 3);
    check_every_cut(test::without(plate, [](idx c) { return c % 17 == 5; })); // small holes everywhere
    check_every_cut(test::both(plate, test::tube(12, 3.0)));
}

TEST_CASE("cluster_tree: faces of a box are whole before they are united")
{
    const auto m = test::box(8);
    const auto f = facets(m);
    const auto tree = make_cluster_tree(m, f);
    const idx merges = tree.triangles - 6; // each leaves one piece less
    const auto seam = seams_after(tree, f, merges);
    const auto charts = cut_charts(m, f, seam);
    REQUIRE(charts.charts() == 6);
    for (idx k = 0; k < 6; ++k)
        CHECK(charts.first_cell[static_cast<std::size_t>(k) + 1] - charts.first_cell[static_cast<std::size_t>(k)] ==
              m.cell_count() / 6);
}

TEST_CASE("cluster_tree: seams that are to be kept are kept")
{
    const auto m = test::bumpy(16);
    const auto f = facets(m);
    std::vector<char> keep(f.twin.size(), 0);
    for (std::size_t s = 0; s < keep.size(); ++s)
    {
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        keep[s] = f.twin[s] >= 0 && (a + b) % 7 == 0;
    }
    const auto tree = make_cluster_tree(m, f, keep);
    const auto seam = seams_after(tree, f, static_cast<idx>(tree.children.size()));
    for (std::size_t s = 0; s < keep.size(); ++s)
        if (keep[s]) CHECK(seam[s]);
    test::check_flattenable(m, f, seam);
}

TEST_CASE("cluster_tree: strain of a piece is that of its normals, and nothing on planes and cylinders")
{
    const auto strain = [](const mesh<triangle>& m)
    {
        const auto tree = make_cluster_tree(m, facets(m));
        double sum = 0;
        for (idx n = 0; n < tree.nodes(); ++n)
            if (tree.parents[static_cast<std::size_t>(n)] == cluster_tree::none)
                sum += tree.strain[static_cast<std::size_t>(n)];
        return sum / std::accumulate(tree.area.begin(), tree.area.begin() + tree.triangles, 0.0);
    };
    CHECK(strain(test::grid(20, 20)) < 1e-9);
    CHECK(strain(test::cap(24, 0.3)) < 1e-3);
    CHECK(strain(test::cap(24)) > 0.02);
}

TEST_CASE("cluster_tree: triangles that are to be apart are in different pieces, and pieces remain disks")
{
    for (const auto& m : {test::ball(8), test::bumpy(16), test::torus(12, true)})
    {
        const auto f = facets(m);
        std::vector<std::array<idx, 2>> apart;
        for (idx c = 0; c + 40 < m.cell_count(); c += 41) apart.push_back({c, c + 40});
        const auto tree = make_cluster_tree(m, f, {}, {}, apart);
        std::vector<char> roots;
        for (const idx parent : tree.parents) roots.push_back(parent == cluster_tree::none);
        const auto label = tree.labels(roots);
        for (const auto& [a, b] : apart)
            CHECK(label[static_cast<std::size_t>(a)] != label[static_cast<std::size_t>(b)]);
        const idx charts = test::check_flattenable(m, f, tree.seams(f, label));
        CHECK(charts >= 2);
        CHECK(charts < m.cell_count() / 4);
    }
}

TEST_CASE("cluster_tree: what is united when the time is over can be flattened")
{
    const auto m = test::bumpy(80);
    const auto f = facets(m);
    for (const int questions : {0, 1, 3})
    {
        int asked = 0;
        budget limits(budget::unlimited, [&](const progress&) { return ++asked <= questions; });
        const auto tree = make_cluster_tree(m, f, {}, {}, {}, &limits);
        CHECK(limits.over());
        CHECK(asked == questions + 1);
        std::vector<char> roots;
        for (const idx parent : tree.parents) roots.push_back(parent == cluster_tree::none);
        CHECK(test::check_flattenable(m, f, tree.seams(f, tree.labels(roots))) > 1);
    }
}
