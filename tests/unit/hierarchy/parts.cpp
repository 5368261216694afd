// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "support.hpp"
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/hierarchy/star_energy.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

impl::ring_image ring_of(const std::vector<vec2>& corners, bool open = false)
{
    impl::ring_image r;
    r.size = corners.size();
    r.open = open;
    std::copy(corners.begin(), corners.end(), r.corner.begin());
    return r;
}

/// A planar star of n neighbours at irregular distances.
std::vector<vec3> star(int n)
{
    std::vector<vec3> spokes;
    for (int i = 0; i < n; ++i)
    {
        const double a = 2 * std::numbers::pi * (i + 0.3 * std::sin(5.0 * i)) / n, r = 1 + 0.4 * std::cos(3.0 * i);
        spokes.emplace_back(r * std::cos(a), r * std::sin(a), 0);
    }
    return spokes;
}

} // namespace

TEST_CASE("rings: neighbours are in order, and the triangles come back")
{
    const auto m = test::bumpy(12);
    std::vector<char> open;
    const auto rings = impl::make_rings(m.cells(), m.points().size(), open, 1);
    auto cells = impl::ring_cells(rings, open);
    const auto canonical = [](std::vector<std::array<taut::idx, 3>> list)
    {
        for (auto& t : list) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        std::sort(list.begin(), list.end());
        return list;
    };
    CHECK(canonical(cells) == canonical(m.cells()));
    for (std::size_t v = 0; v < open.size(); ++v)
    {
        const vec3& p = m.points()[v];
        CHECK((open[v] != 0) == (p.x == 0 || p.x == 1 || p.y == 0 || p.y == 1));
    }
}

TEST_CASE("flat star: a planar star keeps its shape")
{
    const auto spokes = star(7);
    std::vector<vec3> points = {vec3(3, -2, 1)};
    std::vector<taut::idx> ring;
    for (const vec3& s : spokes)
    {
        ring.push_back(static_cast<taut::idx>(points.size()));
        points.push_back(points[0] + vec3(s.y, s.z, s.x)); // in the plane y = -2
    }
    for (const bool open : {false, true})
    {
        const auto flat = impl::flatten(points, 0, std::span(ring).first(open ? 5 : 7), open);
        for (std::size_t i = 0; i < flat.size; ++i)
        {
            CHECK(glm::length(flat.corner[i]) == doctest::Approx(glm::length(spokes[i])));
            for (std::size_t j = 0; j < i; ++j)
                CHECK(glm::distance(flat.corner[i], flat.corner[j]) ==
                      doctest::Approx(glm::distance(spokes[i], spokes[j])));
        }
    }
}

TEST_CASE("flat star: a cone fills the full turn")
{
    std::vector<vec3> points = {vec3(0, 0, 2)};
    std::vector<taut::idx> ring;
    for (int i = 0; i < 5; ++i)
    {
        ring.push_back(static_cast<taut::idx>(points.size()));
        points.emplace_back(std::cos(0.4 * std::numbers::pi * i), std::sin(0.4 * std::numbers::pi * i), 0);
    }
    const auto flat = impl::flatten(points, 0, ring, false);
    for (std::size_t i = 0; i < 5; ++i)
    {
        const vec2 a = flat.corner[i], b = flat.corner[flat.next(i)];
        CHECK(glm::length(a) == doctest::Approx(std::sqrt(5.0)));
        CHECK(std::atan2(impl::cross(a, b), glm::dot(a, b)) == doctest::Approx(0.4 * std::numbers::pi));
    }
}

TEST_CASE("kernel: a point that sees the whole ring is found, however thin the kernel")
{
    std::mt19937 rng(3);
    const auto uniform = [&] { return double(rng()) / 4294967296.0; };
    int spikes = 0;
    for (int trial = 0; trial < 2000; ++trial)
    {
        // A fan from corner 0 with random radii: valid by construction, rarely convex.
        const int n = 3 + int(uniform() * 8);
        std::vector<vec2> corners = {vec2(0)};
        double angle = 0;
        for (int i = 1; i < n; ++i)
        {
            angle += 0.02 + 2.4 / n * uniform();
            corners.push_back(std::pow(10.0, 3 * uniform() - 1.5) * vec2(std::cos(angle), std::sin(angle)));
        }
        const auto ring = ring_of(corners);
        vec2 p;
        REQUIRE(impl::kernel_point(ring, 0, p));
        for (std::size_t i = 0; i < ring.size; ++i)
            REQUIRE(orient2d(p, ring.corner[i], ring.corner[ring.next(i)]) == 1);
        vec2 centre(0);
        for (const vec2& c : corners) centre += c / double(n);
        spikes += ring.sees(centre) ? 0 : 1;
    }
    CHECK(spikes > 200); // the easy guess would not have done
}

TEST_CASE("kernel: none is reported for a ring without")
{
    vec2 p;
    CHECK(!impl::kernel_point(ring_of({{0, 0}, {0, 1}, {1, 0}}), 0, p)); // clockwise
    CHECK(!impl::kernel_point(ring_of({{0, 0}, {1, 0}, {2, 0}}), 0, p)); // flat
    // A horseshoe: no point sees both of its ends.
    CHECK(!impl::kernel_point(ring_of({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2.9, 0.1}, {0.1, 0.1}, {1, 3}, {0, 3}}), 0, p));
}

TEST_CASE("kernel: a boundary ring leaves room outside the mesh")
{
    const auto ring = ring_of({{1, 0}, {0, 1}, {-1, 0}}, true);
    vec2 p;
    REQUIRE(impl::kernel_point(ring, 0, p));
    for (std::size_t i = 0; i + 1 < ring.size; ++i) CHECK(orient2d(p, ring.corner[i], ring.corner[i + 1]) == 1);
}

TEST_CASE("sure orientation: never claims more than exact arithmetic")
{
    std::mt19937 rng(5);
    int claimed = 0;
    for (int trial = 0; trial < 20000; ++trial)
    {
        // Points near a line, a few units in the last place off.
        const auto near = [&](double t) { return vec2(0.1 + t, 0.3 + t / 3 + double(int(rng() % 9) - 4) * 0x1p-54); };
        const vec2 a = near(double(rng()) / 4294967296.0), b = near(double(rng()) / 4294967296.0),
                   c = near(double(rng()) / 4294967296.0);
        if (!impl::surely_positive(a, b, c)) continue;
        ++claimed;
        REQUIRE(orient2d(a, b, c) == 1);
    }
    CHECK(claimed > 0);
    CHECK(impl::surely_positive({0, 0}, {1, 0}, {0, 1}));
    CHECK(!impl::surely_positive({0, 0}, {0, 1}, {1, 0}));
    CHECK(!impl::surely_positive({0, 0}, {1, 1}, {2, 2}));
    CHECK(!impl::surely_positive({0, 0}, {NAN, 0}, {0, 1}));
}

TEST_CASE("star energy: derivatives agree with differences, and rest is a minimum")
{
    const auto rest = star(6);
    std::vector<vec2> image;
    for (const vec3& s : rest) image.emplace_back(1.3 * s.x + 0.2 * s.y, 0.8 * s.y);
    const auto ring = ring_of(image);
    const impl::star_energy energy(ring, rest);
    const vec2 p(0.07, -0.11);
    vec2 g;
    mat2 h;
    energy.derivatives(p, g, h);
    const double step = 1e-5;
    for (int k = 0; k < 2; ++k)
    {
        vec2 d(0);
        d[k] = step;
        CHECK(g[k] == doctest::Approx((energy.value(p + d) - energy.value(p - d)) / (2 * step)).epsilon(1e-6));
        vec2 high, low;
        mat2 ignored;
        energy.derivatives(p + d, high, ignored);
        energy.derivatives(p - d, low, ignored);
        for (int j = 0; j < 2; ++j) CHECK(h[k][j] == doctest::Approx((high[j] - low[j]) / (2 * step)).epsilon(1e-5));
    }
    CHECK(std::isinf(energy.value(vec2(9, 9))));

    std::vector<vec2> same;
    double area = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
        same.emplace_back(rest[i].x, rest[i].y);
        area += 0.5 * glm::length(glm::cross(rest[i], rest[(i + 1) % rest.size()]));
    }
    const auto identity = ring_of(same);
    const impl::star_energy at_rest(identity, rest);
    CHECK(at_rest.value(vec2(0)) == doctest::Approx(4 * area));
    vec2 q(0.1, 0.05);
    impl::relax(at_rest, identity, q, 8);
    CHECK(glm::length(q) < 1e-6);
}

TEST_CASE("star energy: the step goes down, also where the energy is not convex")
{
    const mat2 saddle(1, 2, 2, -3);
    const vec2 g(0.4, -1);
    CHECK(glm::dot(impl::newton_direction(g, saddle), g) < 0);
    // Where it is, the step is Newton's.
    const mat2 convex(3, 1, 1, 2);
    CHECK(glm::length(convex * impl::newton_direction(g, convex) + g) < 1e-14);
}
