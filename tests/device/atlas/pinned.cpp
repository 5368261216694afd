// SPDX-License-Identifier: MIT
#include <array>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/shared_context.hpp>

#include <taut/atlas.hpp>

using namespace taut;

namespace
{

/// Squares of two triangles side by side, laid in a row; the last one is folded.
struct squares
{
    std::vector<vec3> points;
    std::vector<std::array<taut::idx, 3>> cells;
    std::vector<std::array<vec2, 3>> uv;

    explicit squares(int count)
    {
        for (int k = 0; k < count; ++k)
        {
            const auto b = static_cast<taut::idx>(points.size());
            const std::array<vec2, 4> corner{vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)};
            std::array<vec2, 4> x;
            for (std::size_t i = 0; i < 4; ++i)
            {
                points.emplace_back(corner[i].x + 2 * k, corner[i].y, 0);
                x[i] = vec2(0.02 + 0.3 * k, 0.02) + 0.2 * corner[i];
            }
            if (k + 1 == count) x[3] = x[1] + vec2(0.05, -0.01);
            cells.push_back({b, b + 1, b + 2});
            cells.push_back({b, b + 2, b + 3});
            uv.push_back({x[0], x[1], x[2]});
            uv.push_back({x[0], x[2], x[3]});
        }
    }
};

} // namespace

TEST_CASE("make_atlas: beside pinned charts, tiles and faults are of the triangles of the whole surface")
{
    queue q(test::shared_context());
    const squares s(3);
    const mesh<triangle> m(s.points, s.cells);
    atlas_params params{.initial = s.uv, .pinned = {1, 1, 0, 0, 0, 0}, .packing = {.groups = {0, 0, 1, 1, 0, 0}}};
    params.packing.tiles = 2;
    const atlas made = make_atlas(q, m, params);
    REQUIRE(made.report.reason == "");
    const auto corners = made.corners();
    for (std::size_t c = 0; c < corners.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec2 x = made.uv[static_cast<std::size_t>(corners[c][k])];
            CHECK((x.x > 1) == (params.packing.groups[c] == 1));
            if (params.pinned[c]) CHECK(x == s.uv[c][k]);
        }

    params.prefer = chart_preference::laid;
    const atlas folded = make_atlas(q, m, params);
    CHECK(folded.report.reason.find("the chart of triangle 4 is folded") == 0);
    CHECK(folded.report.reason_triangles == std::vector<taut::idx>{4});
}
