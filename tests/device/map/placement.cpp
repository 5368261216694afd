// SPDX-License-Identifier: MIT
// Where a map comes to lie that nothing holds.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>

#include <taut/impl/core/map/place_map.hpp>
#include <taut/parameterize.hpp>

namespace
{

using namespace taut;

/// Points moved by f, the triangles as they are.
template <class F>
mesh<triangle> with_points(const mesh<triangle>& m, F&& f)
{
    auto points = m.points();
    for (vec3& p : points) p = f(p);
    return {points, m.cells()};
}

/// A dome of no symmetry, over a region that is longer in x.
mesh<triangle> hill()
{
    return with_points(test::bumpy(12, 0.2, 3),
                       [](vec3 p) { return vec3(1.4 * p.x + 0.3 * p.y, p.y, p.z + p.x * p.x); });
}

mesh<triangle> rounded(const mesh<triangle>& m)
{
    return with_points(m, [](vec3 p) { return vec3(glm::vec3(p)); });
}

/// The same surface, its vertices and triangles in another order.
struct shuffled
{
    std::vector<taut::idx> new_to_old;
    mesh<triangle> surface;

    explicit shuffled(const mesh<triangle>& m, unsigned seed) : shuffled(m, order(m.points().size(), seed), seed) {}

private:
    shuffled(const mesh<triangle>& m, std::vector<taut::idx> numbers, unsigned seed)
        : new_to_old(numbers), surface(renumbered(m, numbers, seed))
    {
    }

    static std::vector<taut::idx> order(std::size_t n, unsigned seed)
    {
        std::vector<taut::idx> numbers(n);
        std::iota(numbers.begin(), numbers.end(), 0);
        std::shuffle(numbers.begin(), numbers.end(), std::mt19937(seed));
        return numbers;
    }

    static mesh<triangle> renumbered(const mesh<triangle>& m, const std::vector<taut::idx>& new_to_old, unsigned seed)
    {
        std::vector<vec3> points;
        std::vector<taut::idx> old_to_new(new_to_old.size());
        for (const taut::idx v : new_to_old)
        {
            old_to_new[static_cast<std::size_t>(v)] = static_cast<taut::idx>(points.size());
            points.push_back(m.points()[static_cast<std::size_t>(v)]);
        }
        auto cells = m.cells();
        std::mt19937 random(seed);
        for (auto& c : cells)
        {
            for (auto& v : c) v = old_to_new[static_cast<std::size_t>(v)];
            std::rotate(c.begin(), c.begin() + static_cast<int>(random() % 3), c.end());
        }
        std::shuffle(cells.begin(), cells.end(), random);
        return {points, cells};
    }
};

double largest_difference(const std::vector<vec2>& a, const std::vector<vec2>& b)
{
    double most = 0;
    for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, glm::distance(a[v], b[v]));
    return most;
}

std::pair<vec2, vec2> box(const std::vector<vec2>& uv)
{
    vec2 least(INFINITY), most(-INFINITY);
    for (const vec2& p : uv) least = glm::min(least, p), most = glm::max(most, p);
    return {least, most};
}

std::vector<vec2> free_map(queue& q, const mesh<triangle>& m, parameterize_params p = {})
{
    p.solve.gradient_tolerance = 1e-8;
    const auto r = parameterize(q, m, p);
    REQUIRE(r);
    CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
    return r.uv;
}

} // namespace

TEST_CASE("placement: the map of a surface, of its rounding to float and of its translation lie in one place")
{
    queue q(test::shared_context());
    for (const auto& m : {hill(), test::tube(10, 1.5), test::cap(8)})
    {
        const auto uv = free_map(q, m);
        CHECK(box(uv).first == vec2(0, 0));
        CHECK(largest_difference(uv, free_map(q, rounded(m))) < 1e-4);
        const auto moved = with_points(m, [](vec3 p) { return p + vec3(16, -4, 64); });
        CHECK(largest_difference(uv, free_map(q, moved)) < 1e-4);
    }
}

TEST_CASE("placement: the order of vertices, triangles and corners does not matter")
{
    queue q(test::shared_context());
    const auto m = hill();
    const auto uv = free_map(q, m);
    for (const unsigned seed : {1u, 2u, 3u})
    {
        const shuffled other(m, seed);
        const auto found = free_map(q, other.surface);
        double most = 0;
        for (std::size_t v = 0; v < found.size(); ++v)
            most = std::max(most, glm::distance(found[v], uv[static_cast<std::size_t>(other.new_to_old[v])]));
        CHECK(most < 1e-4);
    }
}

TEST_CASE("placement: a map does not depend on where its start lies, unless it is left as solved")
{
    queue q(test::shared_context());
    const auto m = hill();
    const auto uv = free_map(q, m);
    auto turned = uv;
    for (vec2& p : turned) p = vec2(5 - p.y, p.x - 7);
    CHECK(largest_difference(uv, free_map(q, m, {.initial = turned})) < 1e-4);
    CHECK(largest_difference(uv, free_map(q, m, {.initial = turned, .placement = placement::as_solved})) > 0.5);
}

TEST_CASE("placement: a flat surface lies as it does in space, and up is up on a tube that was cut open")
{
    queue q(test::shared_context());
    const auto flat = test::grid(6, 9);
    const auto uv = free_map(q, flat);
    for (std::size_t v = 0; v < uv.size(); ++v)
        CHECK(glm::distance(uv[v], vec2(flat.points()[v].x, flat.points()[v].y)) < 1e-6);

    // Around y and around z the tube stands, around x it lies.
    for (const int axis : {1, 2, 0})
    {
        const auto strip = with_points(test::grid(24, 8),
                                       [&](vec3 p)
                                       {
                                           const double a = 1.9 * std::numbers::pi * p.x;
                                           vec3 at;
                                           at[axis] = p.y;
                                           at[(axis + 1) % 3] = std::sin(a) / 3;
                                           at[(axis + 2) % 3] = std::cos(a) / 3;
                                           return at;
                                       });
        const auto map = free_map(q, strip);
        for (std::size_t v = 0; v < map.size(); ++v)
            CHECK(map[v][axis == 0 ? 0 : 1] == doctest::Approx(strip.points()[v][axis]).epsilon(1e-3));
    }
}

TEST_CASE("placement: a dome with y up lies as it is seen from above")
{
    queue q(test::shared_context());
    const auto dome = with_points(test::cap(8, 2), [](vec3 p) { return vec3(p.x, p.z, -p.y); });
    const auto map = free_map(q, dome);
    const auto at = [&](auto farthest)
    {
        const auto& p = dome.points();
        const auto far =
            std::max_element(p.begin(), p.end(), [&](vec3 a, vec3 b) { return farthest(a) < farthest(b); });
        return map[static_cast<std::size_t>(far - p.begin())];
    };
    CHECK(at([](vec3 p) { return p.x; }).x > at([](vec3 p) { return -p.x; }).x + 1);
    CHECK(at([](vec3 p) { return -p.z; }).y > at([](vec3 p) { return p.z; }).y + 1);
}

TEST_CASE("placement: a torus that was cut open shows no axis and lies along its longer side")
{
    const auto flat = test::grid(40, 16);
    const auto torus = with_points(flat,
                                   [](vec3 p)
                                   {
                                       const double a = 2 * std::numbers::pi * p.x, b = 2 * std::numbers::pi * p.y;
                                       const double r = 3 + std::cos(b);
                                       return vec3(r * std::cos(a), r * std::sin(a), std::sin(b));
                                   });
    for (const double angle : {0.0, 0.4, 2.0, -2.5})
    {
        std::vector<vec2> uv; // a trapezoid, wider on the left
        for (const vec3& p : flat.points())
        {
            const vec2 at(6 * p.x, (2 - p.x) * (p.y - 0.5));
            uv.push_back(
                {std::cos(angle) * at.x - std::sin(angle) * at.y, std::sin(angle) * at.x + std::cos(angle) * at.y});
        }
        const auto placed = impl::in_corner(impl::turned_up(torus, uv), 0).uv;
        const auto at = [&](std::size_t k) { return placed[k]; };
        CHECK(at(40).x - at(0).x == doctest::Approx(6)); // the thin end is on the right
        CHECK(at(41 * 16).y - at(0).y == doctest::Approx(2));
    }
}

TEST_CASE("placement: the unit square is filled along one side, and the report tells the scale")
{
    queue q(test::shared_context());
    const auto m = with_points(hill(), [](vec3 p) { return 300.0 * p; });
    const auto uv = free_map(q, m);
    const auto r = parameterize(q, m, {.placement = placement::unit_square});
    REQUIRE(r);
    const auto [least, most] = box(r.uv);
    CHECK(least == vec2(0, 0));
    CHECK(std::max(most.x, most.y) == 1);
    CHECK(std::min(most.x, most.y) < 1);
    auto back = r.uv;
    for (vec2& p : back) p /= r.report.scale;
    CHECK(largest_difference(uv, back) < 0.1);
    CHECK(r.report.scale == doctest::Approx(1 / std::max(box(uv).second.x, box(uv).second.y)).epsilon(1e-3));
}

TEST_CASE("placement: a map that is held is never moved")
{
    queue q(test::shared_context());
    const auto m = hill();
    for (const auto where : {placement::upright, placement::unit_square})
    {
        constraints<triangle> pins(m);
        pins.pin(5, {3.25, -2.5});
        const auto pinned = parameterize(q, m, {.constraints = pins, .placement = where});
        REQUIRE(pinned);
        CHECK(pinned.uv[5] == vec2(3.25, -2.5));
        CHECK(pinned.report.scale == 1);
        const auto fixed = parameterize(q, m, {.boundary = boundary_mode::fixed, .placement = where});
        REQUIRE(fixed);
        if (where == placement::unit_square)
        {
            const auto [least, most] = box(fixed.uv);
            CHECK(least == vec2(0));
            CHECK(std::max(most.x, most.y) == 1);
        }
        else
            CHECK(box(fixed.uv).first.x < 0);
    }
}
