// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/shared_context.hpp>

#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/parameterize.hpp>

namespace
{

using namespace taut;

/// Rough hills of n by n quads, and the quad of each triangle.
struct quad_hills
{
    explicit quad_hills(idx n) : surface(rough(n))
    {
        for (idx k = 0; k < n * n; ++k) quad.insert(quad.end(), 2, k);
    }

    static mesh<triangle> rough(idx n)
    {
        std::vector<vec3> points;
        for (idx y = 0; y <= n; ++y)
            for (idx x = 0; x <= n; ++x)
                points.emplace_back(
                    x, y, 4.0 * std::sin(0.9 * x + 0.3 * y) * std::cos(1.1 * y) + 0.9 * ((x * 7 + y * 5) % 3));
        std::vector<std::array<idx, 3>> cells;
        for (idx y = 0; y < n; ++y)
            for (idx x = 0; x < n; ++x)
            {
                const idx a = y * (n + 1) + x;
                cells.push_back({a, a + 1, a + n + 2});
                cells.push_back({a, a + n + 2, a + n + 1});
            }
        return {std::move(points), std::move(cells)};
    }

    std::size_t concave(const std::vector<vec2>& uv) const
    {
        return taut::impl::find_concave(taut::impl::find_convex_polygons(surface.cells(), quad, surface.points()), uv)
            .size();
    }

    mesh<triangle> surface;
    std::vector<idx> quad;
};

TEST_CASE("convex polygons: quads that are convex in space are so in the map, with pins and no overlaps, too")
{
    queue q(test::shared_context());
    const idx n = 12;
    const quad_hills h(n);
    parameterize_params params;
    REQUIRE(h.concave(parameterize(q, h.surface, params).uv) > 0); // else there is nothing to see
    params.polygons = h.quad;
    const auto check = [&]
    {
        const auto r = parameterize(q, h.surface, params);
        REQUIRE(r);
        CHECK(h.concave(r.uv) == 0);
        CHECK(r.report.concave.empty());
        CHECK(certify<2>(h.surface.cells(), std::span<const vec2>(r.uv)));
        for (const auto& [v, pin] : params.constraints.pins()) CHECK(r.uv[static_cast<std::size_t>(v)] == pin.value);
    };
    check();
    params.no_overlap = true;
    check();
    params.no_overlap = false;
    const auto free = parameterize(q, h.surface, params).uv;
    const auto a = static_cast<std::size_t>((n / 3) * (n + 1) + n / 3),
               b = static_cast<std::size_t>((n / 2) * (n + 1) + 2);
    params.constraints = constraints<triangle>(h.surface);
    params.constraints.pin(static_cast<idx>(a), free[a]).pin(static_cast<idx>(b), free[b] + vec2(1.5, 0.5));
    check();
}

TEST_CASE("convex polygons: one that pins make concave stays so, and is told")
{
    queue q(test::shared_context());
    const idx n = 6;
    const quad_hills h(n);
    parameterize_params params{.polygons = h.quad};
    const auto convex = taut::impl::find_convex_polygons(h.surface.cells(), h.quad, h.surface.points());
    const auto inner = std::find_if(convex.numbers.begin(), convex.numbers.end(),
                                    [](idx k) { return k % n > 0 && k % n < n - 1 && k / n > 0 && k / n < n - 1; });
    REQUIRE(inner != convex.numbers.end());
    const idx a = *inner / n * (n + 1) + *inner % n, b = a + 1, c = a + n + 2, d = a + n + 1;
    const auto free = parameterize(q, h.surface, params).uv;
    const auto at = [&free](idx v) { return free[static_cast<std::size_t>(v)]; };
    params.constraints = constraints<triangle>(h.surface);
    params.constraints.pin(b, at(b)).pin(c, at(c)).pin(d, at(d)).pin(a, at(c) + 0.3 * (at(a) - at(c)));
    const auto r = parameterize(q, h.surface, params);
    REQUIRE(r);
    CHECK(certify<2>(h.surface.cells(), std::span<const vec2>(r.uv)));
    CHECK(r.report.concave == std::vector<idx>{*inner});
    CHECK(h.concave(r.uv) == 1);
    REQUIRE_FALSE(r.report.notes.empty());
    CHECK(r.report.notes.back().find("1 polygon is not convex in the map") != std::string::npos);
    params.polygons.pop_back();
    CHECK_THROWS_AS(parameterize(q, h.surface, params), parameter_error);
}

} // namespace
