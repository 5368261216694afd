// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <support/at.hpp>
#include <support/closed_meshes.hpp>
#include <support/meshes.hpp>
#include <taut/impl/charts/atlas/cutting/coarse_surface.hpp>
#include <taut/impl/charts/atlas/cutting/lift_seams.hpp>
#include <taut/impl/charts/atlas/cutting/part_charts.hpp>
#include <taut/impl/charts/atlas/cutting/seam_search.hpp>
#include <taut/impl/charts/atlas/cutting/short_cutting.hpp>
#include <taut/impl/charts/atlas/filled_square.hpp>
#include <taut/impl/charts/atlas/filling_cuts.hpp>
#include <taut/impl/core/solve/line/line_search.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A box of cubes blown up to a ball with limbs.
mesh<triangle> limbs(int n)
{
    const auto box = test::cubes({{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, n);
    return box;
}

rest_surface rest_of(const mesh<triangle>& m)
{
    return rest_surface::of(m, m.cell_count());
}

/// V - E + F.
idx euler(const mesh<triangle>& m)
{
    const auto f = facets(m);
    idx edges = 0;
    for (std::size_t s = 0; s < f.twin.size(); ++s) edges += f.twin[s] < static_cast<idx>(s);
    return m.vertex_count() - edges + m.cell_count();
}

void check_no_flips(const rest_surface& rest, const flat_surface& flat)
{
    for (idx c = 0; c < rest.triangles(); ++c)
        CHECK(energy_of(rest, flat.uv, c) < std::numeric_limits<double>::infinity());
    for (std::size_t corner = 0; corner < flat.fan.size(); ++corner)
    {
        const auto side = static_cast<idx>(corner);
        if (rest.twin(side) < 0 || flat.seam[corner]) continue;
        const idx a = rest_surface::start_corner(side), b = rest_surface::end_corner(rest.twin(side));
        CHECK(flat.uv[at(a)] == flat.uv[at(b)]); // connected where there is no seam
    }
}

} // namespace

TEST_CASE("coarse surface: vertices of the fine one, the same topology, about as many triangles as asked")
{
    for (const auto& m :
         {limbs(12),
          test::cubes({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}}, 8)})
    {
        const auto coarse = make_coarse(m, facets(m), 600);
        const mesh<triangle> small(coarse.points, coarse.cells);
        CHECK(small.cell_count() <= 600);
        CHECK(small.cell_count() > 500);
        CHECK(euler(small) == euler(m));
        CHECK(facets(small).oriented());
        for (std::size_t v = 0; v < coarse.points.size(); ++v)
            CHECK(coarse.points[v] == m.points()[at(coarse.origins[v])]);
        const auto again = make_coarse(m, facets(m), 600);
        CHECK(again.cells == coarse.cells);
    }
    const auto m = limbs(2);
    CHECK(make_coarse(m, facets(m), 10'000).cells == m.cells());
}

TEST_CASE("coarse surface: small holes are spanned, large ones stay")
{
    const auto whole = limbs(6);
    auto cells = whole.cells();
    cells.erase(cells.begin(), cells.begin() + 2); // one quad
    coarse_surface s{whole.points(), cells, {}};
    const idx first = span_small_holes(s);
    CHECK(first == static_cast<idx>(cells.size()));
    CHECK(s.cells.size() == cells.size() + 4);
    CHECK(euler(mesh<triangle>(s.points, s.cells)) == 2);
    std::vector<std::array<idx, 3>> half;
    for (const auto& t : whole.cells())
        if (whole.points()[at(t[0])].x + whole.points()[at(t[1])].x + whole.points()[at(t[2])].x < 1.5)
            half.push_back(t);
    coarse_surface open{whole.points(), half, {}};
    span_small_holes(open);
    CHECK(open.cells.size() == half.size());
}

TEST_CASE("curvature potential: greatest at the tips of limbs")
{
    const rest_surface rest = rest_of(limbs(6));
    curvature_potential potential(rest);
    std::vector<char> zero(rest.surface.points().size(), 0);
    for (std::size_t v = 0; v < zero.size(); ++v)
        if (rest.surface.points()[v] == vec3(0.5, 0.5, 0.0)) zero[v] = 1;
    REQUIRE(std::count(zero.begin(), zero.end(), char(1)) == 1);
    const auto phi = potential(zero);
    const auto top = std::max_element(phi.begin(), phi.end()) - phi.begin();
    const vec3 p = rest.surface.points()[static_cast<std::size_t>(top)];
    CHECK(std::max({std::abs(p.x - 0.5), std::abs(p.y - 0.5), std::abs(p.z - 0.5)}) == doctest::Approx(1.5));
}

TEST_CASE("zip: sews up one edge, costs what it says, and can be taken back")
{
    const rest_surface rest = rest_of(limbs(5));
    flat_surface flat;
    flat.seam.assign(rest.facets.twin.size(), 0);
    over_cutting(rest, 0.3).run(flat.seam, 0.3, 100);
    number_fans(rest, flat);
    const cut_surface cut = cut_surface::of(rest, flat);
    const mesh<triangle> disk(cut.points, cut.cells);
    REQUIRE(euler(disk) == 1);
    const auto map = barycentric_map(disk, {.stretch_rounds = 1});
    flat.uv.resize(flat.fan.size());
    for (std::size_t k = 0; k < flat.fan.size(); ++k) flat.uv[k] = map.uv[at(cut.cells[k / 3][k % 3])];
    relax(rest, flat, 60, 1e-8);
    check_no_flips(rest, flat);
    CHECK(flat.energy == doctest::Approx(mean_energy(rest, flat.uv)));
    zipper zips(rest, 100);
    int done = 0;
    for (idx v = 0; v < rest.vertices(); ++v)
    {
        if (seam_degree(rest, flat.seam, v) != 1) continue;
        const zip z = zips.look(flat, v);
        if (!(z.more < std::numeric_limits<double>::infinity())) continue;
        const flat_surface was = flat;
        const auto remembered = zips.remember(flat, z);
        zips.apply(flat, z);
        check_no_flips(rest, flat);
        CHECK(flat.energy == doctest::Approx(mean_energy(rest, flat.uv)).epsilon(1e-9));
        CHECK(seam_price(rest, flat.seam) == doctest::Approx(seam_price(rest, was.seam) - rest.length[at(z.side)]));
        flat_surface back = flat;
        zips.take_back(back, z, remembered);
        CHECK(back.seam == was.seam);
        CHECK(back.uv == was.uv);
        CHECK(back.fan == was.fan);
        CHECK(back.fan_cells == was.fan_cells);
        if (++done == 5) break;
    }
    CHECK(done > 0);
}

TEST_CASE("needles around one vertex: they come into few squares of a grid, and its row alone is full")
{
    constexpr idx around = 3000;
    std::vector<vec3> points = {{0, 0, 0}};
    std::vector<std::array<idx, 3>> cells;
    for (idx i = 0; i < around; ++i)
    {
        const double a = 2 * std::numbers::pi * i / around;
        points.push_back({std::cos(a), std::sin(a), 0});
        cells.push_back({0, 1 + i, 1 + (i + 1) % around});
    }
    const rest_surface rest = rest_of(mesh<triangle>(points, cells));
    std::vector<vec2> uv;
    map_patch patch;
    for (idx c = 0; c < around; ++c)
    {
        patch.triangles.push_back(c);
        patch.cells.push_back(cells[at(c)]);
        for (const idx v : cells[at(c)]) uv.emplace_back(points[at(v)]);
    }
    CHECK(triangle_grid(rest, uv).inside().items.size() < 200 * around); // 2,400,000 in their boxes
    const std::vector<idx> one(at(around), 0);
    CHECK(overlapping_pairs(rest, uv, one).empty());
    for (idx v = 0; v <= around; ++v)
    {
        patch.x.emplace_back(1.1 * points[at(v)]);
        patch.slot.push_back(patch.moving++);
    }
    patch_newton newton;
    const double before = patch.energy(rest, patch.x);
    CHECK(newton.run(rest, patch, 1, 0) < before);
    CHECK(newton.entries() < 20 * at(around)); // where that row is in the middle, 5,000,000
}

TEST_CASE("overlaps: a strip that lies on itself is parted by a cut across it")
{
    // A helix of 1.5 turns, seen from above. No vertex lies on another.
    constexpr int around = 61, across = 4;
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (int i = 0; i <= around; ++i)
        for (int j = 0; j <= across; ++j)
        {
            const double a = 3 * std::numbers::pi * i / around, r = 2 + 0.25 * j;
            points.push_back({r * std::cos(a), r * std::sin(a), 0.001 * i});
        }
    for (idx i = 0; i < around; ++i)
        for (idx j = 0; j < across; ++j)
        {
            const idx a = i * (across + 1) + j, b = a + across + 1;
            cells.push_back({a, a + 1, b + 1});
            cells.push_back({a, b + 1, b});
        }
    const rest_surface rest = rest_of(mesh<triangle>(points, cells));
    flat_surface flat;
    flat.seam.assign(rest.facets.twin.size(), 0);
    number_fans(rest, flat);
    for (std::size_t k = 0; k < flat.fan.size(); ++k)
    {
        const vec3 p = points[at(rest.vertex(static_cast<idx>(k)))];
        flat.uv.push_back({p.x, p.y});
    }
    flat.energy = mean_energy(rest, flat.uv);
    const auto found = find_overlaps(rest, flat);
    REQUIRE(found.size() == 1);
    CHECK(found[0].area == doctest::Approx(rest.total / 3).epsilon(0.05));
    const auto cut = minimum_cutting(rest).run(flat.seam, found[0].below, found[0].above);
    double length = 0;
    for (const idx s : cut) length += rest.length[at(s)];
    CHECK(length == doctest::Approx(1).epsilon(0.02)); // the width
    // As it is laid, so that nothing but the seams changes.
    auto laid = flat.seam;
    auto uv = flat.uv;
    std::vector<idx> all(rest.surface.cells().size());
    std::iota(all.begin(), all.end(), idx(0));
    CHECK(part_laid(rest.surface, {laid, uv, all}, {rest.price, {}}));
    CHECK(uv == flat.uv);
    CHECK(pieces_between(rest.facets, laid).second == 2);
    CHECK(seam_price(rest, laid) == doctest::Approx(1).epsilon(0.02));
    CHECK_FALSE(part_laid(rest.surface, {laid, uv, all}, {rest.price, {}}));

    CHECK(part_charts(rest, flat, {}) == 1);
    CHECK(pieces_between(rest.facets, flat.seam).second == 2);
    CHECK(border_crossings(rest, flat, 1) == 0);
    check_no_flips(rest, flat);
}

TEST_CASE("parting: a chart whose ends lie on each other by less than triangles are told apart")
{
    // A strip around a hole, laid so that its end is beyond its beginning by a hair.
    constexpr idx around = 40;
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (idx i = 0; i <= around; ++i)
        for (const double r : {2.0, 2.5})
        {
            const double a = 2 * std::numbers::pi * i / around + (i == around ? 1e-9 : 0);
            points.emplace_back(r * std::cos(a), r * std::sin(a), 0);
        }
    for (idx i = 0; i < 2 * around; i += 2)
    {
        cells.push_back({i, i + 1, i + 3});
        cells.push_back({i, i + 3, i + 2});
    }
    const rest_surface rest = rest_of(mesh<triangle>(points, cells));
    std::vector<vec2> uv;
    for (const auto& t : cells)
        for (const idx v : t) uv.emplace_back(points[at(v)]);
    std::vector<char> seam(rest.facets.twin.size(), 0);
    std::vector<idx> all(cells.size());
    std::iota(all.begin(), all.end(), idx(0));
    flat_surface flat{.seam = seam, .uv = uv, .fan = {}, .fan_cells = {}};
    number_fans(rest, flat);
    REQUIRE(find_overlaps(rest, flat).empty());
    REQUIRE(border_crossings(rest, flat, 1) == 1);
    CHECK(part_laid(rest.surface, {seam, uv, all}, {rest.price, {}}));
    flat.seam = seam;
    number_fans(rest, flat);
    CHECK(border_crossings(rest, flat, 1) == 0);
    CHECK(pieces_between(rest.facets, seam).second == 2);
}

TEST_CASE("coarse surface: ends when it is told to")
{
    const auto m = test::ball(40);
    int asked = 0;
    const auto coarse = make_coarse(m, facets(m), 200, [&] { return ++asked < 2; });
    CHECK(asked > 1);
    CHECK(std::ssize(coarse.cells) > 200);
}

TEST_CASE("crumbs: a small chart goes back to its neighbour, unless something lies there")
{
    constexpr idx n = 12, few = 2; // squares a side, of the crumb
    const rest_surface rest = rest_of(test::grid(n, n));
    const auto in_crumb = [&](idx c)
    {
        const auto x = rest.surface.rest(c);
        const vec3 middle = (x[0] + x[1] + x[2]) / 3.0;
        return middle.x * n < few && middle.y * n < few;
    };
    flat_surface flat;
    flat.seam.assign(rest.facets.twin.size(), 0);
    for (idx s = 0; s < static_cast<idx>(flat.seam.size()); ++s)
    {
        if (rest.twin(s) >= 0 && in_crumb(s / 3) != in_crumb(rest.twin(s) / 3)) flat.seam[at(s)] = 1;
        const vec3 p = rest.surface.points()[at(rest.vertex(s))];
        flat.uv.push_back(in_crumb(s / 3) ? vec2(5 - p.y, 7 + p.x) : vec2(p)); // turned and moved
    }
    number_fans(rest, flat);
    flat.energy = mean_energy(rest, flat.uv);
    auto given = flat;
    CHECK(crumb_giving(rest, given, 10).run() == 1);
    CHECK(seam_length(rest, given.seam) == 0);
    CHECK(given.energy == doctest::Approx(4));
    check_no_flips(rest, given);

    // The corner opposite is folded over, to where it was.
    for (std::size_t k = 0; k < flat.uv.size(); ++k)
        if (const vec2 p = flat.uv[k]; !in_crumb(static_cast<idx>(k / 3)) && p.x > 0.5 && p.y > 0.5)
            flat.uv[k] = p - vec2(1.0 - double(few) / n);
    CHECK(crumb_giving(rest, flat, 10).run() == 0);
}

TEST_CASE("seam search: within the bound, and a looser one makes no longer seams beyond a tenth")
{
    for (const auto& m :
         {limbs(6),
          test::cubes({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}}, 4)})
    {
        const rest_surface rest = rest_of(m);
        double before = std::numeric_limits<double>::infinity();
        for (const double bound : {4.05, 4.1, 4.3})
        {
            seam_search search(rest, {.bound = bound});
            REQUIRE(search.run());
            CHECK(search.result().energy <= bound);
            CHECK(search.result().energy == doctest::Approx(mean_energy(rest, search.result().uv)));
            check_no_flips(rest, search.result());
            CHECK(search.price() < 1.1 * before);
            before = std::min(before, search.price());
        }
    }
}

TEST_CASE("seam search: seams of a rough surface stay short, and the bound gives")
{
    const rest_surface smooth = rest_of(test::ball(10)), rough = rest_of(test::noisy(smooth.surface, 0.4));
    seam_search of_smooth(smooth, {}), of_rough(rough, {});
    REQUIRE(of_smooth.run());
    CHECK_FALSE(of_smooth.rough());
    REQUIRE(of_rough.run());
    CHECK(of_rough.rough());
    CHECK(of_rough.result().energy > search_setting{}.bound);
    CHECK(of_rough.result().energy <= of_rough.setting().bound);
    CHECK(seam_price(rough, of_rough.result().seam) < 13 * std::sqrt(rough.total));
    CHECK(pieces_between(rough.facets, of_rough.result().seam).second < 20);
    check_no_flips(rough, of_rough.result());
}

TEST_CASE("minimum cuts: as short as those by single augmenting paths")
{
    const rest_surface rest = [] // of random prices
    {
        rest_surface r = rest_of(test::grid(9, 7));
        std::minstd_rand random(3);
        for (idx s = 0; s < static_cast<idx>(r.price.size()); ++s)
            if (r.twin(s) > s) r.price[at(s)] = r.price[at(r.twin(s))] = 1 + static_cast<double>(random() % 1000);
        return r;
    }();
    const std::vector<char> none(rest.price.size(), 0);
    minimum_cutting between(rest); // what one leaves does not show in the next
    for (idx k = 0; k < 20; ++k)
    {
        const std::vector<idx> from{3 * k, 3 * k + 1}, to{rest.triangles() - 1 - k, rest.triangles() - 30 - k};
        double cut = 0;
        for (const idx s : between.run(none, from, to)) cut += rest.price[at(s)];
        // The largest flow, by depth first.
        std::vector<double> left = rest.price;
        double flow = 0;
        for (;;)
        {
            std::vector<idx> came(at(rest.triangles()), -1), stack = from;
            idx end = -1;
            while (!stack.empty() && end < 0)
            {
                const idx c = stack.back();
                stack.pop_back();
                if (std::find(to.begin(), to.end(), c) != to.end()) end = c;
                for (idx s = 3 * c; s < 3 * c + 3; ++s)
                {
                    if (rest.twin(s) < 0 || !(left[at(s)] > 0)) continue;
                    const idx d = rest.twin(s) / 3;
                    if (came[at(d)] >= 0 || std::find(from.begin(), from.end(), d) != from.end()) continue;
                    came[at(d)] = s;
                    stack.push_back(d);
                }
            }
            if (end < 0) break;
            double most = std::numeric_limits<double>::infinity();
            for (idx c = end; came[at(c)] >= 0; c = came[at(c)] / 3) most = std::min(most, left[at(came[at(c)])]);
            for (idx c = end; came[at(c)] >= 0; c = came[at(c)] / 3)
            {
                left[at(came[at(c)])] -= most;
                left[at(rest.twin(came[at(c)]))] += most;
            }
            flow += most;
        }
        CHECK(cut == flow); // whole numbers
    }
}

TEST_CASE("seam search: what is flat already gets no seams")
{
    const rest_surface rest = rest_of(test::grid(12, 12));
    seam_search search(rest, {});
    REQUIRE(search.run());
    CHECK(search.price() == 0);
    CHECK(search.result().energy == doctest::Approx(4));
}

TEST_CASE("seam search: what is within the bound as it is, holes and all, is left so")
{
    for (const auto& m : {test::annulus(24), test::cap(6, 0.3)})
    {
        const rest_surface rest = rest_of(m);
        seam_search search(rest, {});
        REQUIRE(search.run_whole());
        CHECK(search.price() == 0);
        CHECK(search.result().energy < 4.1);
        check_no_flips(rest, search.result());
    }
    for (const auto& m : {test::cap(6, 2.5), test::box(2), test::torus(6, true)})
    {
        const rest_surface rest = rest_of(m);
        CHECK_FALSE(seam_search(rest, {}).run_whole());
    }
}

TEST_CASE("short cutting: seams lead back over the fine surface, given ones stay, unwanted ones are avoided")
{
    const auto m = limbs(24);
    const auto f = facets(m);
    std::vector<char> given(f.twin.size(), 0), together(f.twin.size(), 0);
    given[3] = given[at(f.twin[3])] = 1;
    for (std::size_t s = 0; s < f.twin.size(); ++s)
    {
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        together[s] = glm::distance(m.points()[at(a)], m.points()[at(b)]) > 1.2 / 24; // diagonals of quads
    }
    given[3] = given[at(f.twin[3])] = !together[3];
    budget unlimited;
    short_cutting cutting(m, f, {.seams = given, .together = together, .coarse = 1000}, unlimited);
    cutting.run();
    const auto unfound = cutting.unfound();
    CHECK(std::count(unfound.begin(), unfound.end(), char(1)) == 0);
    const auto seam = cutting.seams();
    idx sides = 0;
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        CHECK(seam[s] == seam[at(f.twin[s])]);
        CHECK((!given[s] || seam[s]));
        CHECK((!seam[s] || !together[s]));
        sides += seam[s];
    }
    CHECK(sides > 20);
    const auto charts = cut_charts(m, f, seam);
    CHECK(charts.charts() <= 6);
    short_cutting again(m, f, {.seams = given, .together = together, .coarse = 1000}, unlimited);
    again.run();
    CHECK(again.seams() == seam);
}

TEST_CASE("short cutting: noise that coarser surfaces do not show makes a surface rough")
{
    const auto smooth = test::cubes({{0, 0, 0}}, 36), rough = test::noisy(smooth, 0.06);
    for (const auto* m : {&smooth, &rough})
    {
        const auto f = facets(*m);
        budget unlimited;
        short_cutting cutting(*m, f, {.coarse = 300}, unlimited);
        cutting.run();
        CHECK(cutting.rough() == (m == &rough));
        const auto before = cutting.seams();
        cutting.adjust(-0.05, false);
        if (cutting.rough()) CHECK(cutting.seams() == before); // those for what is large stay
    }
}

TEST_CASE("short cutting: of a surface of many handles, the loops alone are known to be too long")
{
    const auto plain = test::box(4), pierced = test::pierced_plate(3, 4);
    CHECK(least_loops(plain, facets(plain)) == 0);
    const auto least = [](const mesh<triangle>& m)
    {
        const auto [a, b] = std::pair(m.points()[0], m.points()[1]);
        double shortest = glm::distance(a, b);
        for (const auto& t : m.cells())
            shortest = std::min(shortest, glm::distance(m.points()[at(t[0])], m.points()[at(t[1])]));
        return shortest;
    };
    CHECK(least_loops(pierced, facets(pierced)) == doctest::Approx(6 * least(pierced)));
    const auto many = test::pierced_plate(1000, 1);
    const auto f = facets(many);
    budget unlimited;
    short_cutting cutting(many, f, {.coarse = 300}, unlimited);
    cutting.run();
    const auto unfound = cutting.unfound();
    CHECK(std::find(unfound.begin(), unfound.end(), char(0)) == unfound.end());
    CHECK(cutting.area() == doctest::Approx(area_of(many, 0, many.cell_count())));
}

TEST_CASE("strained cuts: a surface is flat when they lead to all of its vertices")
{
    const rest_surface rest = rest_of(limbs(3));
    flat_surface flat;
    flat.seam.assign(rest.facets.twin.size(), 0);
    over_cutting(rest, 0.3).run(flat.seam, 2.0, 1);
    number_fans(rest, flat);
    const cut_surface cut = cut_surface::of(rest, flat);
    const mesh<triangle> disk(cut.points, cut.cells);
    const auto map = barycentric_map(disk, {.stretch_rounds = 1});
    flat.uv.resize(flat.fan.size());
    for (std::size_t k = 0; k < flat.fan.size(); ++k) flat.uv[k] = map.uv[at(cut.cells[k / 3][k % 3])];
    relax(rest, flat, 60, 1e-6);
    REQUIRE(flat.energy > 4.5);
    double before = flat.energy;
    for (int turn = 0; turn < 30 && flat.energy > 4.01; ++turn)
    {
        REQUIRE(cut_strained(rest, flat, 0.5 * (flat.energy - 4)) > 0);
        number_fans(rest, flat);
        relax(rest, flat, 60, 1e-6);
        CHECK(flat.energy <= before);
        before = flat.energy;
        check_no_flips(rest, flat);
    }
    CHECK(flat.energy <= 4.01);
}

TEST_CASE("seam search: plain shapes of a dozen triangles are within the bound")
{
    for (const double bound : {4.1, 4.02, 4.001})
    {
        const rest_surface rest = rest_of(limbs(1));
        seam_search search(rest, {.bound = bound, .over = 0.85});
        REQUIRE(search.run());
        CHECK(search.result().energy <= bound);
        check_no_flips(rest, search.result());
        // Where layers are parted everywhere, no border meets itself.
        seam_search parted(rest, {.bound = bound, .over = 0.85, .everywhere = true});
        REQUIRE(parted.run());
        CHECK(parted.result().energy <= bound);
        CHECK(parted.overlap() < 1e-9);
    }
}

TEST_CASE("straightening: corners of a coarse mesh stay on the seam")
{
    const auto m = test::cubes({{0, 0, 0}}, 1);
    const auto f = facets(m);
    const auto sides = starting_sides(m);
    std::vector<char> seam(f.twin.size(), 0);
    const auto rest = rest_of(m);
    // Over three corners of a face: the diagonal is shorter.
    for (idx s = 0; s < 3 && std::count(seam.begin(), seam.end(), char(1)) == 0; ++s)
    {
        const double longest = std::max({rest.length[0], rest.length[1], rest.length[2]});
        if (rest.length[at(s)] < longest) continue;
        for (const idx side : {rest_surface::next(s), rest_surface::last(s)}) set_seam(rest, seam, side, 1);
    }
    REQUIRE(std::count(seam.begin(), seam.end(), char(1)) == 4);
    budget unlimited;
    auto moved = seam;
    straighten(m, f, moved, {}, {}, unlimited, rest.price, {.distance = 0.1, .least_length = 0.6});
    CHECK(moved == seam);
    straighten(m, f, moved, {}, {}, unlimited, rest.price, {.distance = 1, .least_length = 0.6});
    CHECK(seam_price(rest, moved) < seam_price(rest, seam));
}

TEST_CASE("waist cuts: part a bar between its ends")
{
    std::set<test::cube_cell> boxes;
    for (int x = 0; x < 8; ++x) boxes.insert({x, 0, 0});
    const auto m = test::cubes(boxes, 2);
    const auto rest = rest_of(m);
    std::vector<idx> all(m.cells().size());
    std::iota(all.begin(), all.end(), idx(0));
    const std::vector<char> none(rest.price.size(), 0);
    const auto cuts = waist_cutting(m, all, none, rest.price).cuts();
    REQUIRE(cuts.size() > 5);
    for (std::size_t k = 0; k < cuts.size(); ++k)
    {
        const auto& one = cuts[k];
        if (k < 5) CHECK(one.price == doctest::Approx(4)); // around the bar; others are around corners
        auto seam = none;
        for (const std::size_t s : one.sides) set_seam(rest, seam, static_cast<idx>(s), 1);
        CHECK(pieces_between(rest.facets, seam).second == 2);
    }
}

TEST_CASE("filled squares: arms are cut off though one alone gains nothing, within the length that is allowed")
{
    // A cross whose arms are four squares long, in the plane.
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::map<std::array<idx, 2>, idx> number;
    const auto at = [&](idx x, idx y)
    {
        const auto [found, added] = number.emplace(std::array{x, y}, static_cast<idx>(points.size()));
        if (added) points.emplace_back(x, y, 0);
        return found->second;
    };
    for (idx x = -4; x <= 4; ++x)
        for (idx y = -4; y <= 4; ++y)
        {
            if (x != 0 && y != 0) continue;
            cells.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            cells.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    const mesh<triangle> m(points, cells);
    const auto f = facets(m);
    std::vector<vec2> uv;
    for (const auto& t : cells)
        for (const idx v : t) uv.emplace_back(points[static_cast<std::size_t>(v)]);
    const auto price = side_prices(m, f, {}, {});
    filled_square filling(m, f, uv, price, {});
    const std::vector<char> none(f.twin.size(), 0);
    const double before = filling.use_of(none);
    CHECK(before < 0.35); // turned by 45 degrees
    const auto seam = filling.run(none, 4.5, [] { return true; });
    CHECK(filling.use_of(seam) > 1.4 * before);
    CHECK(length_of_seams(m, f, seam) < 4.5);
    CHECK(filled_square(m, f, uv, price, {}).run(none, 0.5, [] { return true; }) == none);
}
