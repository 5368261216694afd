// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <support/edit_meshes.hpp>
#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <taut/impl/charts/paste/surface/surface_tree.hpp>
#include <taut/impl/charts/paste/write_feature_map.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/paste.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A mushroom on a sphere, in the sphere's map.
struct mapped_mushroom
{
    queue q{test::shared_context()};
    paste pasted{q, test::sphere(4), feature(geodesic_disk(test::mushroom(24), 0, 2.2)), 4, {.pose = {.scale = 0.4}}};
    map_result map = pasted.parameterize_feature(q);
};

/// The weights of the corners of the triangle at p, in the plane.
vec3 weights_at(const vec2& a, const vec2& b, const vec2& c, const vec2& p)
{
    const auto cross = [](const vec2& u, const vec2& v) { return u.x * v.y - u.y * v.x; };
    const double det = cross(b - a, c - a), v = cross(p - a, c - a) / det, w = cross(b - a, p - a) / det;
    return {1 - v - w, v, w};
}

/// Holds each texel against the triangle that is deepest at its middle; how many are covered.
idx covered_as_on_host(const feature_map& map, const feature& part, const std::vector<vec2>& uv)
{
    const auto& cells = part.region.surface.cells();
    const mat3 to_frame = glm::transpose(part.frame());
    idx covered = 0;
    for (idx j = 0; j < map.height; ++j)
        for (idx i = 0; i < map.width; ++i)
        {
            const vec2 p = map.low + map.texel * vec2(i + 0.5, j + 0.5);
            double deepest = -1e9;
            vec3 expected(0.0);
            for (const auto& t : cells)
            {
                const auto at = [&](std::size_t k) { return uv[std::size_t(t[k])]; };
                const vec3 w = weights_at(at(0), at(1), at(2), p);
                const double least = std::min({w.x, w.y, w.z});
                if (least <= deepest) continue;
                deepest = least;
                expected = vec3(0.0);
                for (int k = 0; k < 3; ++k)
                    expected += w[k] * part.region.surface.points()[std::size_t(t[std::size_t(k)])];
            }
            if (deepest > 1e-3) REQUIRE(map.covers(i, j)); // no hole
            if (deepest < -1e-2) REQUIRE_FALSE(map.covers(i, j));
            if (!map.covers(i, j)) continue;
            ++covered;
            const float* v = &map.values[4 * std::size_t(j * map.width + i)];
            const vec3 drawn{double(v[0]), double(v[1]), double(v[2])};
            if (deepest > 1e-3) REQUIRE(glm::distance(drawn, to_frame * (expected - part.centre)) < 1e-4);
        }
    return covered;
}

} // namespace

TEST_CASE("parameterize feature: the rim bit for bit at its correspondences, nothing flipped; contradictions have ids")
{
    mapped_mushroom m;
    REQUIRE(m.map);
    const auto& region = m.pasted.part().region;
    for (std::size_t i = 0; i < region.rim.size(); ++i)
        CHECK(m.map.uv[std::size_t(region.rim[i])] == m.pasted.rim_uv()[i]);
    const auto outside = 100.0 * m.pasted.rim_uv()[0];
    const auto refused = m.pasted.parameterize_feature(m.q, std::vector<feature_pin>{{0, outside}});
    CHECK(refused.report.outcome == outcome::infeasible);
    CHECK_FALSE(refused.report.ids.empty());
}

TEST_CASE("feature map: the device draws what the host says, without holes or bleeding")
{
    mapped_mushroom m;
    REQUIRE(m.map);
    const auto& part = m.pasted.part();
    const auto map = part.rasterize(m.q, m.map.uv, 128);
    CHECK(std::max(map.width, map.height) <= 130);
    CHECK(covered_as_on_host(map, part, m.map.uv) > 5000);
    CHECK(map.round_trip_rms < map.footprint);
    CHECK(map.round_trip < 8 * map.footprint);
    const auto finer = part.rasterize(m.q, m.map.uv, 512);
    CHECK(finer.round_trip_rms < 0.5 * map.round_trip_rms);

    // Sampling: host and device, also beyond the rim, where the map is continued.
    std::vector<vec2> points;
    for (const vec2& p : m.pasted.rim_uv()) points.push_back(p + map.texel * vec2(0.7, -0.4));
    for (const vec2& p : m.map.uv) points.push_back(p);
    const auto sampled = sample(m.q, map, points);
    for (std::size_t n = 0; n < points.size(); ++n) CHECK(glm::distance(sampled[n], map(points[n])) < 1e-4);

    CHECK_THROWS_AS(part.rasterize(m.q, points), parameter_error);
    CHECK_THROWS_AS(part.rasterize(m.q, m.map.uv, 4), parameter_error);
}

TEST_CASE("feature map: of a part that is seen from above, drawn and sampled")
{
    queue q(test::shared_context());
    const feature part(geodesic_disk(test::bumpy(8, 0.3), 40, 0.4));
    std::vector<vec2> uv;
    for (const vec3& p : part.region.surface.points()) uv.emplace_back(p.x, p.y);
    const auto map = part.rasterize(q, uv, 24);
    CHECK(covered_as_on_host(map, part, uv) > 100);
    const auto sampled = sample(q, map, uv);
    for (std::size_t n = 0; n < uv.size(); ++n) CHECK(glm::distance(sampled[n], map(uv[n])) < 1e-4);
}

TEST_CASE("tessellate: a feature of about as many triangles as wanted, on the map, its rim as it was")
{
    mapped_mushroom m;
    REQUIRE(m.map);
    const auto& part = m.pasted.part();
    const auto map = part.rasterize(m.q, m.map.uv, 128);
    double before = 1e9;
    for (const int wanted : {600, 2400, 9600})
    {
        const auto made = part.tessellate(m.q, map, m.map.uv, wanted);
        CHECK(check(made.region.surface).empty());
        CHECK(made.region.surface.cell_count() < 1.2 * wanted);
        CHECK(made.region.surface.cell_count() > 0.5 * wanted);
        // Vertices of the source are near to it, the nearer the finer.
        const impl::surface_tree tree(made.region.surface.points(), made.region.surface.cells());
        double worst = 0;
        for (const vec3& x : part.region.surface.points()) worst = std::max(worst, tree.nearest(x).distance);
        CHECK(worst < before);
        before = worst;

        auto again = paste(m.q, test::sphere(4), part, 4, {.pose = {.scale = 0.4}});
        again.refill(made);
        CHECK(check(again.surface(), {.open = false, .one_boundary = false}).empty());
    }
    CHECK(before < 0.5 * map.footprint);
    CHECK_THROWS_AS(m.pasted.refill(feature(geodesic_disk(test::mushroom(24), 0, 1.9))), parameter_error);
}

TEST_CASE("feature map: files")
{
    mapped_mushroom m;
    REQUIRE(m.map);
    const auto map = m.pasted.part().rasterize(m.q, m.map.uv, 64);
    const std::string exr = map.exr();
    const auto texels = std::size_t(map.width * map.height);
    CHECK(exr.substr(0, 8) == std::string("\x76\x2f\x31\x01\x02\0\0\0", 8));
    CHECK(exr.size() > 16 * texels);
    CHECK(exr.size() < 16 * texels + 16 * std::size_t(map.height) + 600);
    // The last line of the file is the first row, its last channel R: x.
    float last = 0;
    std::copy_n(exr.data() + exr.size() - 4, 4, reinterpret_cast<char*>(&last));
    CHECK(last == map.values[4 * (std::size_t(map.width) - 1)]);
}
