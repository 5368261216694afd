// SPDX-License-Identifier: MIT
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/untangle.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

using kind = infeasibility_kind;

/// A problem whose vertices chosen by `pinned` hold.
template <class Element, class Pinned>
untangle_problem<Element> problem(const mesh<Element>& m, std::vector<vec<Element::dimension>> x, const Pinned& pinned)
{
    fixed_marks<Element::dimension> held(x.size());
    for (std::size_t v = 0; v < held.size(); ++v)
        if (pinned(static_cast<taut::idx>(v))) held[v] = held.every;
    return {m, std::move(x), std::move(held)};
}

template <class Element>
std::vector<vec<Element::dimension>> rest_map(const mesh<Element>& m)
{
    std::vector<vec<Element::dimension>> x;
    for (const vec3& p : m.points()) x.emplace_back(p);
    return x;
}

std::vector<char> on_boundary(const mesh<triangle>& m)
{
    std::vector<char> flags(m.points().size(), 0);
    for (const auto& edge : boundary_facets(m)) flags[std::size_t(edge[0])] = 1;
    return flags;
}

/// The problem of a disk's boundary alone, at the images of the rest positions.
template <class Place>
untangle_problem<triangle> boundary_problem(const mesh<triangle>& m, const Place& place)
{
    const auto rim = on_boundary(m);
    std::vector<vec2> x;
    for (const vec3& p : m.points()) x.push_back(place(vec2(p)));
    return problem(m, std::move(x), [&](taut::idx v) { return rim[std::size_t(v)] != 0; });
}

bool proves(const infeasibility& found, kind what)
{
    return std::any_of(found.proofs.begin(), found.proofs.end(), [&](const auto& f) { return f.kind == what; });
}

} // namespace

TEST_CASE("infeasible: an element with all vertices pinned, flipped or flat, is named")
{
    const auto m = test::grid(3, 3);
    auto p = problem(m, rest_map(m), [](taut::idx v) { return v == 5 || v == 6 || v == 10; });
    CHECK(!find_infeasibility(p));
    const auto cell = [&](taut::idx c) { return m.cells()[std::size_t(c)]; };
    taut::idx pinned = -1;
    for (taut::idx c = 0; c < m.cell_count(); ++c)
    {
        const auto t = cell(c);
        if (std::all_of(t.begin(), t.end(), [&](taut::idx v) { return p.held.all(std::size_t(v)); })) pinned = c;
    }
    REQUIRE(pinned >= 0);
    p.initial[10] = (p.initial[5] + p.initial[6]) / 2.0; // on the edge: flat
    auto found = find_infeasibility(p);
    REQUIRE(found.proofs.size() == 1);
    CHECK(found.proofs[0].kind == kind::inverted_element);
    CHECK(found.proofs[0].ids == std::vector<taut::idx>{pinned});
    CHECK(found.reason().find("triangle (" + std::to_string(pinned) + ")") != std::string::npos);
    p.initial[10] = p.initial[5] - vec2(0, 1);
    CHECK(proves(find_infeasibility(p), kind::inverted_element));

    // One coordinate free: nobody can tell.
    p.held[10] = 1;
    CHECK(!find_infeasibility(p));

    const auto volume = test::cube(2);
    auto q = problem(volume, rest_map(volume), [](taut::idx) { return true; });
    CHECK(!find_infeasibility(q));
    q.initial[13] = vec3(3, 3, 3);
    CHECK(proves(find_infeasibility(q), kind::inverted_element));
}

TEST_CASE("infeasible: what is held can make an element flat that is partly free")
{
    const auto m = test::grid(2, 2);
    auto p = problem(m, rest_map(m), [](taut::idx) { return false; });
    for (std::size_t v = 0; v < 3; ++v) p.held[v] = 2; // the lower side slides along y = 0
    CHECK(!find_infeasibility(p));
    p.held[4] = 2; // as if the centre lay on the side, too
    p.initial[4].y = 0;
    CHECK(proves(find_infeasibility(p), kind::flat_element));

    auto q = problem(m, rest_map(m), [](taut::idx v) { return v == 3 || v == 4; });
    CHECK(!find_infeasibility(q));
    q.initial[4] = q.initial[3]; // neighbours at one point
    CHECK(proves(find_infeasibility(q), kind::flat_element));

    const auto volume = test::single_tetrahedron();
    auto r = problem(volume, rest_map(volume), [](taut::idx v) { return v != 3; });
    CHECK(!find_infeasibility(r));
    r.initial[2] = 0.25 * r.initial[0] + 0.75 * r.initial[1]; // three corners on a line
    CHECK(proves(find_infeasibility(r), kind::flat_element));
}

TEST_CASE("infeasible: a mirrored or empty pinned boundary is proved by its area")
{
    const auto m = test::flat_disk(6);
    CHECK(!find_infeasibility(boundary_problem(m, [](const vec2& p) { return p; })));
    const auto mirrored = find_infeasibility(boundary_problem(m, [](const vec2& p) { return vec2(-p.x, p.y); }));
    REQUIRE(mirrored.proofs.size() == 1);
    CHECK(mirrored.proofs[0].kind == kind::outline_measure);
    CHECK(mirrored.proofs[0].ids.size() == 36); // the boundary, in order
    CHECK(mirrored.reason().find("the pinned boundary") != std::string::npos);
    CHECK(mirrored.reason().find("the area -3.126;") !=
          std::string::npos); // of a polygon of 36 corners, 18 sin(10 degrees)
    CHECK(proves(find_infeasibility(boundary_problem(m, [](const vec2& p) { return vec2(p.x, 0); })),
                 kind::outline_measure));

    // One free boundary vertex, and nothing is known.
    auto p = boundary_problem(m, [](const vec2& q) { return vec2(-q.x, q.y); });
    p.held[p.held.size() - 1] = 0;
    CHECK(!proves(find_infeasibility(p), kind::outline_measure));

    // A hole is run around the other way: only the sum of the areas counts.
    const auto ring = test::annulus(8);
    CHECK(!find_infeasibility(boundary_problem(ring, [](const vec2& q) { return q; })));

    const auto volume = test::cube(3);
    std::vector<vec3> x = rest_map(volume);
    for (vec3& q : x) q.z = -q.z;
    const auto q = problem(volume, x, [&](taut::idx v) { return x[std::size_t(v)] != vec3(1. / 3) || v == 0; });
    CHECK(find_infeasibility(q));
}

TEST_CASE(
    "infeasible: a pinned boundary like an eight is proved by its turning, one with a loop outside by its winding")
{
    const auto m = test::flat_disk(8);
    const auto angle = [](const vec2& p) { return std::atan2(p.y, p.x); };
    // Lissajous' figure, with a larger lobe, so that the area is positive.
    const auto eight = boundary_problem(m,
                                        [&](const vec2& p)
                                        {
                                            const double a = angle(p);
                                            const double r = std::cos(a) > 0 ? 2 : 1;
                                            return r * vec2(std::cos(a), std::sin(2 * a));
                                        });
    auto found = find_infeasibility(eight);
    REQUIRE(found);
    CHECK(!proves(found, kind::outline_measure));
    CHECK((proves(found, kind::outline_turning) || proves(found, kind::outline_winding)));
    CHECK(!found.warnings.empty());

    // Three curls inside make up for the turning that loops outside take away: only the winding tells.
    const auto curls = boundary_problem(m,
                                        [&](const vec2& p)
                                        {
                                            const double a = angle(p);
                                            const std::complex<double> z = std::polar(1.0, a);
                                            const auto w = z + 0.3 * std::pow(z, 4) + 0.9 / z;
                                            return vec2(w.real(), w.imag());
                                        });
    found = find_infeasibility(curls);
    REQUIRE(found.proofs.size() == 1);
    CHECK(found.proofs[0].kind == kind::outline_winding);
}

TEST_CASE("infeasible: overlap without a fold is no proof, but told")
{
    // A strip laid along a spiral of nearly two rounds whose second covers part of the first: every triangle is
    // positive.
    const auto m = test::grid(40, 2);
    const auto spiral = [](const vec2& p)
    {
        const double a = 3.5 * std::numbers::pi * p.x, r = 2 - p.y;
        return r * vec2(std::cos(a), std::sin(a));
    };
    auto p = boundary_problem(m, spiral);
    REQUIRE(certify<2>(m.cells(), std::span<const vec2>(p.initial)).flipped == 0);
    auto found = find_infeasibility(p);
    CHECK(!found);
    CHECK(found.reason().empty());
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].kind == kind::not_globally_injective);
    CHECK(found.warnings[0].ids.size() % 4 == 0);

    // A disk wound twice about its centre: the boundary turns twice, every triangle is positive.
    const auto disk = test::flat_disk(8);
    const auto square = [](const vec2& q) { return vec2(q.x * q.x - q.y * q.y, 2 * q.x * q.y); };
    p = boundary_problem(disk, square);
    REQUIRE(certify<2>(disk.cells(), std::span<const vec2>(p.initial)).flipped == 0);
    CHECK(!find_infeasibility(p));
}

TEST_CASE("infeasible: a free vertex in a pinned ring needs a place that sees all of it")
{
    const auto m = test::fan(6, true); // vertex 0 in a ring of six
    auto p = problem(m, rest_map(m), [](taut::idx v) { return v != 0; });
    CHECK(!find_infeasibility(p));
    p.initial[1] = vec2(-0.2, 0.1); // still star-shaped, though not about the centre
    CHECK(!find_infeasibility(p));
    std::swap(p.initial[2], p.initial[3]);
    auto found = find_infeasibility(p);
    REQUIRE(proves(found, kind::empty_star));
    CHECK(found.proofs[0].ids.size() == 4);
    CHECK(found.proofs[0].ids[0] == 0);

    // A simple polygon of positive area whose kernel is empty: a Z.
    const auto ring8 = test::fan(8, true);
    auto z = problem(ring8, rest_map(ring8), [](taut::idx v) { return v != 0; });
    const std::vector<vec2> outline{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {3, 3}, {0, 3}, {0, 2}, {1.5, 2}};
    for (std::size_t k = 0; k < 8; ++k) z.initial[k + 1] = outline[k];
    found = find_infeasibility(z);
    REQUIRE(found.proofs.size() == 1);
    CHECK(found.proofs[0].kind == kind::empty_star);
    CHECK(found.warnings.empty());

    // Lines that meet in one point leave no open set. All coordinates are exact.
    const auto ring4 = test::fan(4, true);
    auto thin = problem(ring4, rest_map(ring4), [](taut::idx v) { return v != 0; });
    const std::vector<vec2> arrow{{0, 0}, {4, 0}, {1, 0.5}, {0, 4}};
    for (std::size_t k = 0; k < 4; ++k) thin.initial[k + 1] = arrow[k];
    CHECK(!find_infeasibility(thin));
}

TEST_CASE("infeasible: a free vertex in space between opposite half-spaces has no place, exactly")
{
    // An octahedron about vertex 0: eight tetrahedra, all of whose other corners are pinned.
    const std::vector<vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::array<taut::idx, 4>> cells;
    for (const taut::idx k : {0, 1, 2, 3})
    {
        const taut::idx a = 1 + k, b = 1 + (k + 1) % 4;
        cells.push_back({0, a, b, 5});
        cells.push_back({0, b, a, 6});
    }
    const mesh<tetrahedron> m(points, cells);
    const auto at_rest = [&] { return problem(m, rest_map(m), [](taut::idx v) { return v != 0; }); };
    auto p = at_rest();
    CHECK(!find_infeasibility(p));
    p.initial[0] = vec3(0, 0, 3); // outside: it has a place all the same
    CHECK(!find_infeasibility(p));
    p.initial[0] = vec3(0.1, 0.1, 0);
    p.initial[5] = vec3(0, 0, -0x1p-12), p.initial[6] = vec3(0, 0, 0x1p-12); // the apices change sides, by little
    auto found = find_infeasibility(p);
    REQUIRE(proves(found, kind::empty_star));
    CHECK(found.proofs[0].ids.size() == 5);
    CHECK(found.proofs[0].ids[0] == 0);
    CHECK(found.reason().find("tetrahedra are positive, as") != std::string::npos);
    // A floor of two tetrahedra of which one is turned over in its plane: above it and below.
    const mesh<tetrahedron> floor({{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                                  {{0, 1, 3, 2}, {0, 2, 3, 4}});
    auto folded = problem(floor, rest_map(floor), [](taut::idx v) { return v != 0; });
    CHECK(!find_infeasibility(folded));
    folded.initial[4] = vec3(-1, -1, 0);
    found = find_infeasibility(folded);
    REQUIRE(proves(found, kind::empty_star));
    CHECK(found.proofs[0].ids == std::vector<taut::idx>{0, 0, 1, 1, 1});
    folded.initial[4] = vec3(-1, -1, -1e-300); // now there is room, if only there
    CHECK(!find_infeasibility(folded));
    // The corners of cells of other kinds have to be positive as well.
    folded.initial[4] = vec3(-1, -1, 0);
    folded.owners = {0, 0};
    CHECK(proves(find_infeasibility(folded), kind::empty_star));
    // A coordinate that is fixed takes part: all of the others would be free to choose.
    auto level = at_rest();
    level.held[0] = 4;
    level.initial[0] = vec3(0, 0, 2);
    CHECK(proves(find_infeasibility(level), kind::empty_star));
}

TEST_CASE("infeasible: within a simple pinned boundary every pin has its own place")
{
    const auto m = test::grid(8, 8);
    const auto rim = on_boundary(m);
    auto p = problem(m, rest_map(m), [&](taut::idx v) { return rim[std::size_t(v)] || v == 40; });
    CHECK(!find_infeasibility(p));
    p.initial[40] = vec2(1.5, 0.5);
    auto found = find_infeasibility(p);
    REQUIRE(found.proofs.size() == 1);
    CHECK(found.proofs[0].kind == kind::outside_boundary);
    CHECK(found.proofs[0].ids == std::vector<taut::idx>{40});
    p.initial[40] = vec2(1, 0.3); // on the boundary
    CHECK(proves(find_infeasibility(p), kind::outside_boundary));

    // Two edges inside, exchanged and turned so that they cross.
    p = problem(m, rest_map(m),
                [&](taut::idx v) { return rim[std::size_t(v)] || v == 20 || v == 21 || v == 59 || v == 60; });
    CHECK(!find_infeasibility(p));
    const vec2 a(0.4, 0.4), b(0.6, 0.6), c(0.4, 0.6), d(0.6, 0.4);
    p.initial[20] = a, p.initial[21] = b, p.initial[59] = c, p.initial[60] = d;
    found = find_infeasibility(p);
    REQUIRE(found.proofs.size() == 1);
    CHECK(found.proofs[0].kind == kind::crossing_edges);
    CHECK(found.proofs[0].ids.size() == 4);
    CHECK(found.warnings.empty());

    // With a boundary vertex free the sheet can overlap itself.
    p.held[0] = 0;
    found = find_infeasibility(p);
    CHECK(!found);
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].kind == kind::not_globally_injective);
}

TEST_CASE("infeasible: pins of a valid map are never refused")
{
    std::mt19937 rng(5);
    const auto uniform = [&rng] { return double(rng()) / 4294967296.0; };
    int partial = 0;
    for (int round = 0; round < 120; ++round)
    {
        const auto m = round % 3 == 0 ? test::bumpy(6, 0.1, std::uint32_t(round)) : test::flat_disk(4);
        std::vector<vec2> x;
        const double shear = 4 * uniform() - 2, bend = 2 * uniform();
        for (const vec3& p : m.points())
        {
            vec2 q(p.x, p.y);
            if (round % 3 == 1) q = vec2(q.x * q.x - q.y * q.y, 2 * q.x * q.y); // twice around
            q.x += shear * q.y;
            x.push_back((1 + bend * 0.1 * q.x) * q);
        }
        const auto valid = certify<2>(m.cells(), std::span<const vec2>(x));
        if (valid.flipped > 0) continue;
        const double density = uniform();
        auto p = problem(m, x, [&](taut::idx) { return uniform() < density; });
        for (std::size_t v = 0; v < p.held.size(); ++v)
            if (uniform() < 0.1) p.held[v] = std::uint8_t(rng() % 4);
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int k = 0; k < 2; ++k)
                if (!p.held.test(v, k)) p.initial[v][k] = 10 * uniform(); // what is free says nothing
        INFO(round);
        const auto found = find_infeasibility(p);
        if (valid) CHECK(!found);
        for (const auto& proof : found.proofs) CHECK(proof.kind == kind::wound_star);
        ++partial;
    }
    CHECK(partial > 80);

    const auto volume = test::cube(3);
    for (int round = 0; round < 20; ++round)
    {
        std::vector<vec3> x = rest_map(volume);
        for (vec3& q : x) q += 0.03 * vec3(uniform(), uniform(), uniform());
        if (certify<3>(volume.cells(), std::span<const vec3>(x)).flipped > 0) continue;
        const double density = uniform();
        CHECK(!find_infeasibility(problem(volume, x, [&](taut::idx) { return uniform() < density; })));
    }
}

TEST_CASE("infeasible: faulty meshes are judged as far as they can be")
{
    for (const auto& m : {test::moebius(5), test::bowtie(), test::three_on_an_edge(), test::two_components(),
                          test::octahedron(), test::torus(5, true)})
    {
        std::vector<vec2> x;
        for (const vec3& p : m.points()) x.emplace_back(p.x, p.y + 0.1 * p.z);
        CHECK_NOTHROW(find_infeasibility(problem(m, x, [](taut::idx) { return true; })));
        CHECK_NOTHROW(find_infeasibility(problem(m, x, [](taut::idx v) { return v % 3 != 0; })));
        CHECK_NOTHROW(find_infeasibility(problem(m, x, [](taut::idx) { return false; })));
    }
}

TEST_CASE("infeasible: no proof counts on vertices that slide, though stages hold them")
{
    const mesh<triangle> m({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    auto p = problem(m, {{0, 0}, {0, 1}, {1, 0}}, [](taut::idx) { return true; });
    CHECK(find_infeasibility(p));
    p.sliding = {2};
    CHECK_FALSE(find_infeasibility(p));
}
