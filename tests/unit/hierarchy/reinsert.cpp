// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "support.hpp"
#include <taut/certify.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/hierarchy/reinsert.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// From a map of the coarsest level to one of the mesh; checks every level exactly.
std::vector<vec2> refine(const hierarchy<triangle>& h, const mesh<triangle>& m, std::vector<vec2> uv,
                         const reinsert_params& params = {})
{
    for (std::size_t l = h.steps.size(); l-- > 0;)
    {
        CAPTURE(l);
        const auto r = reinsert(h, l, m.points(), uv, params);
        CHECK(r.failed.empty());
        CHECK(certify<2>(h.levels[l].cells, r.uv).flipped == 0);
        uv = r.uv;
    }
    return uv;
}

std::vector<vec2> flat_positions(const hierarchy<triangle>& h, std::size_t level, const mesh<triangle>& m)
{
    std::vector<vec2> uv;
    for (const taut::idx v : h.levels[level].vertices)
        uv.emplace_back(m.points()[static_cast<std::size_t>(v)].x, m.points()[static_cast<std::size_t>(v)].y);
    return uv;
}

double largest_error(const std::vector<vec2>& a, const std::vector<vec2>& b)
{
    double error = 0;
    for (std::size_t i = 0; i < a.size(); ++i) error = std::max(error, glm::distance(a[i], b[i]));
    return error;
}

} // namespace

TEST_CASE("reinsertion: the map of a planar mesh onto itself comes back")
{
    for (const auto& m : {test::grid(30, 30), test::flat_disk(16), test::bumpy(30, 0.0, 2), test::window_frame(36)})
    {
        const auto h = make_hierarchy(m, test::on_boundary(m));
        REQUIRE(h.steps.size() >= 1);
        // The isometry is the local minimum at each vertex once its ring is at rest.
        const auto uv = refine(h, m, flat_positions(h, h.levels.size() - 1, m), {.newton_steps = 6});
        CHECK(largest_error(uv, flat_positions(h, 0, m)) < 1e-6);
    }
}

TEST_CASE("reinsertion: a free boundary in the plane comes back too")
{
    const auto m = test::flat_disk(16);
    const auto h = make_hierarchy(m);
    const auto uv = refine(h, m, flat_positions(h, h.levels.size() - 1, m), {.newton_steps = 6});
    CHECK(largest_error(uv, flat_positions(h, 0, m)) < 1e-6);
}

TEST_CASE("reinsertion: barycentric maps of the coarsest level become injective maps of every finer one")
{
    for (const auto& named : test::thinnable())
        for (const auto shape : {boundary_shape::circle, boundary_shape::square})
            for (const int steps : {0, 3})
            {
                if (named.name == "torus with hole") continue; // not a disk
                CAPTURE(named.name);
                const auto& m = named.surface;
                CAPTURE(steps);
                const auto h = make_hierarchy(m);
                const auto start =
                    barycentric_map(level_mesh(h, h.levels.size() - 1, m.points()), {.boundary = {.shape = shape}});
                REQUIRE(start.flips.flipped == 0);
                refine(h, m, start.uv, {.newton_steps = steps});
            }
}

TEST_CASE("reinsertion: maps at random, as bad as they may be, stay injective")
{
    const auto m = test::bumpy(30, 0.3, 8);
    const auto h = make_hierarchy(m);
    const auto& coarsest = h.levels.back();
    const auto start = barycentric_map(level_mesh(h, h.levels.size() - 1, m.points()));
    std::mt19937 rng(4);
    const auto uniform = [&] { return double(rng()) / 4294967296.0; };
    for (int trial = 0; trial < 20; ++trial)
    {
        CAPTURE(trial);
        // A random walk of each vertex that never flips a triangle, then a strong shear.
        auto uv = start.uv;
        for (int step = 0; step < 4000; ++step)
        {
            const auto v = std::size_t(uniform() * double(uv.size())) % uv.size();
            const vec2 before = uv[v];
            uv[v] += 0.3 * vec2(uniform() - 0.5, uniform() - 0.5);
            for (const auto& t : coarsest.cells)
                if (t[0] == taut::idx(v) || t[1] == taut::idx(v) || t[2] == taut::idx(v))
                    if (orient2d(uv[std::size_t(t[0])], uv[std::size_t(t[1])], uv[std::size_t(t[2])]) <= 0)
                        uv[v] = before;
        }
        for (vec2& p : uv) p = vec2(p.x + 50 * p.y, p.y);
        REQUIRE(certify<2>(coarsest.cells, uv).flipped == 0);
        refine(h, m, uv, {.newton_steps = trial % 4});
    }
}

TEST_CASE("reinsertion: vertices of the coarse map stay where they are, bit for bit")
{
    const auto m = test::bumpy(30, 0.3, 6);
    auto keep = test::on_boundary(m);
    const auto h = make_hierarchy(m, keep);
    const auto start = barycentric_map(level_mesh(h, 1, m.points()));
    const auto r = reinsert(h, 0, m.points(), start.uv);
    for (std::size_t j = 0; j < h.levels[1].vertices.size(); ++j)
        CHECK(r.uv[static_cast<std::size_t>(h.levels[1].vertices[j])] == start.uv[j]);
}

TEST_CASE("reinsertion: the number of threads changes nothing")
{
    const auto m = test::bumpy(110, 0.4, 5);
    const auto h = make_hierarchy(m);
    const auto start = barycentric_map(level_mesh(h, 1, m.points()));
    const auto one = reinsert(h, 0, m.points(), start.uv, {.threads = 1});
    CHECK(one.uv == reinsert(h, 0, m.points(), start.uv, {.threads = 3}).uv);
    CHECK(one.failed.empty());
}

TEST_CASE("reinsertion: newton steps lower the distortion")
{
    const auto m = test::cap(25, 1.5);
    const auto h = make_hierarchy(m);
    const auto start = barycentric_map(level_mesh(h, 1, m.points()));
    const ideal_elements<triangle> ideal(m);
    double before = 1e300;
    for (const int steps : {0, 1, 3})
    {
        const auto uv = reinsert(h, 0, m.points(), start.uv, {.newton_steps = steps}).uv;
        const double e = mean(distortion<triangle>(m, ideal, uv, energy::isometric{}), ideal.measure).measure;
        CHECK(e < before);
        before = e;
    }
}

TEST_CASE("reinsertion: a flipped coarse map is reported, with the vertices that cannot be placed")
{
    const auto m = test::grid(20, 20);
    const auto h = make_hierarchy(m);
    auto uv = flat_positions(h, 1, m);
    for (vec2& p : uv) p.x = -p.x; // every triangle turned over
    const auto r = reinsert(h, 0, m.points(), uv);
    CHECK(r.failed.size() > m.points().size() / 4);
    CHECK(std::is_sorted(r.failed.begin(), r.failed.end()));
    for (const taut::idx v : r.failed)
        CHECK(!std::binary_search(h.levels[1].vertices.begin(), h.levels[1].vertices.end(), v));
}

TEST_CASE("reinsertion: the best scale is where the isometric energy is least")
{
    const auto m = test::cap(12, 1.0);
    const auto h = make_hierarchy(m);
    auto uv = barycentric_map(m).uv;
    for (vec2& p : uv) p *= 7.0;
    const double scale = isometric_scale(h, 0, m.points(), uv);
    const ideal_elements<triangle> ideal(m);
    const auto energy = [&](double s)
    {
        auto x = uv;
        for (vec2& p : x) p *= s;
        return mean(distortion<triangle>(m, ideal, x, energy::isometric{}), ideal.measure).measure;
    };
    CHECK(energy(scale) < energy(1.01 * scale));
    CHECK(energy(scale) < energy(0.99 * scale));

    CHECK(isometric_scale(h, 0, m.points(), std::vector<vec2>(uv.size(), vec2(0))) == 1.0);
}

TEST_CASE("reinsertion: arguments of the wrong size are refused by name")
{
    const auto m = test::grid(20, 20);
    const auto h = make_hierarchy(m);
    const auto uv = flat_positions(h, 1, m);
    const auto field = [&](std::size_t level, std::span<const vec3> points, std::span<const vec2> coarse, int steps)
    {
        try
        {
            reinsert(h, level, points, coarse, {.newton_steps = steps});
        }
        catch (const parameter_error& e)
        {
            return e.field();
        }
        return std::string();
    };
    CHECK(field(0, m.points(), uv, 3).empty());
    CHECK(field(h.steps.size(), m.points(), uv, 3) == "level");
    CHECK(field(0, std::span(m.points()).first(5), uv, 3) == "points");
    CHECK(field(0, m.points(), std::span(uv).first(5), 3) == "coarse");
    CHECK(field(0, m.points(), uv, -1) == "newton_steps");
}
