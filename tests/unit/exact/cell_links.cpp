// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/cell_tetrahedra.hpp>

namespace
{

using namespace taut;
using taut::idx;

/// Cells around the edge from vertex 0 to vertex 1, along z, as the simplices at their corners.
struct fan
{
    std::vector<vec3> x{{0, 0, 0}, {0, 0, 1}};
    std::vector<std::array<idx, 4>> cells;
    std::vector<idx> owners;

    idx point(const vec3& p)
    {
        x.push_back(p);
        return static_cast<idx>(x.size()) - 1;
    }
    void add(const std::vector<idx>& corners, bool edged)
    {
        const idx owner = owners.empty() ? 0 : owners.back() + 1;
        const auto take = [&](const auto& table)
        {
            for (const auto& t : table)
            {
                auto& cell = cells.emplace_back();
                for (std::size_t k = 0; k < 4; ++k) cell[k] = corners[t[k]];
                owners.push_back(owner);
            }
        };
        take(impl::corner_tetrahedra(corners.size()));
        if (edged) take(impl::edge_tetrahedra(corners.size()));
    }
};

enum class kind
{
    tetrahedron,
    flat_wedge,    ///< with a triangle at the edge and a quad
    upright_wedge, ///< with two quads at the edge
    hexahedron,
    side_pyramid, ///< whose apex is at an end of the edge
    base_pyramid  ///< whose base has the edge
};

/// n cells of one kind, going around `times`; at the edge each has half of the side to the next one.
fan wound(kind what, int n, int times, double phase, bool edged = false)
{
    fan f;
    std::vector<idx> low, high;
    for (int k = 0; k < n; ++k)
    {
        const auto at = [&](double radius, double turn, double z)
        {
            const double angle = phase + 2 * std::numbers::pi * times * (k + turn) / n;
            return f.point({radius * std::cos(angle), radius * std::sin(angle), z});
        };
        low.push_back(at(1, 0, 0));
        high.push_back(at(1.2, 0.1, 1.1));
    }
    for (int k = 0; k < n; ++k)
    {
        const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>((k + 1) % n);
        const auto far = [&](double z)
        {
            const double angle = phase + 2 * std::numbers::pi * times * (k + 0.5) / n;
            return f.point({1.7 * std::cos(angle), 1.7 * std::sin(angle), z});
        };
        switch (what)
        {
        case kind::tetrahedron:
            f.add({0, low[i], low[j], 1}, edged);
            break;
        case kind::upright_wedge:
            f.add({0, low[j], low[i], 1, high[j], high[i]}, edged);
            break;
        case kind::hexahedron:
        {
            const idx a = far(0), b = far(1);
            f.add({0, low[i], a, low[j], 1, high[i], b, high[j]}, edged);
            break;
        }
        default:
            break;
        }
    }
    if (what == kind::flat_wedge || what == kind::base_pyramid || what == kind::side_pyramid)
    {
        // The edge lies between a triangle to one side and a quad to the other, in turns.
        for (int k = 0; k < n; ++k)
        {
            const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>((k + 1) % n);
            if (what == kind::side_pyramid)
            {
                const double angle = phase + 2 * std::numbers::pi * times * (k + 0.5) / n;
                const idx a = f.point({1.7 * std::cos(angle), 1.7 * std::sin(angle), -0.2});
                f.add({0, low[i], a, low[j], 1}, edged);
                continue;
            }
            // Odd ones are mirrored, so that quads meet quads.
            const bool quad_first = k % 2 == 0;
            const std::size_t q = quad_first ? i : j, t = quad_first ? j : i;
            if (what == kind::base_pyramid)
                f.add(quad_first ? std::vector<idx>{0, 1, high[q], low[q], low[t]}
                                 : std::vector<idx>{0, low[q], high[q], 1, low[t]},
                      edged);
            else
            {
                // The triangle 0, 1, t and, along the quad's lower edge, another one.
                const double angle = phase + 2 * std::numbers::pi * times * (k + 0.5) / n;
                const idx r = f.point({1.5 * std::cos(angle), 1.5 * std::sin(angle), 0.5});
                f.add(quad_first ? std::vector<idx>{0, 1, low[t], low[q], high[q], r}
                                 : std::vector<idx>{1, 0, low[t], high[q], low[q], r},
                      edged);
            }
        }
    }
    return f;
}

} // namespace

TEST_CASE("links of cells: an edge that cells of any kind go around twice is found")
{
    for (const kind what : {kind::tetrahedron, kind::upright_wedge, kind::flat_wedge, kind::hexahedron,
                            kind::base_pyramid, kind::side_pyramid})
        for (const int n : {12, 14})
            for (int step = 0; step < 8; ++step)
                for (const bool edged : {false, true})
                    for (const int times : {1, 2, 3})
                    {
                        const auto f = wound(what, n, times, 0.1 + step * std::numbers::pi / 4, edged);
                        CAPTURE(int(what));
                        CAPTURE(times);
                        const auto c = certify<3>(f.cells, f.x, {}, 16, f.owners);
                        REQUIRE((edged || c.flipped == 0));
                        if (c.flipped > 0) continue;
                        CHECK(c.branched == (times == 1 ? 0 : 1));
                        if (times > 1) CHECK(c.branch_ids == std::vector<idx>{0, 1});
                    }
}

TEST_CASE("links of cells: a vertex that quads and triangles go around twice is found, in any mixture")
{
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round)
    {
        const int n = 9 + static_cast<int>(random() % 6);
        const double phase = 0.01 * round;
        std::vector<bool> quad;
        for (int k = 0; k < n; ++k) quad.push_back(random() % 2 == 0);
        for (const int times : {1, 2, 3})
        {
            std::vector<vec2> x{{0, 0}};
            std::vector<std::array<idx, 3>> cells;
            std::vector<idx> owners;
            const auto at = [&](double radius, double turn)
            {
                const double angle = phase + 2 * std::numbers::pi * times * turn / n;
                x.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
                return static_cast<idx>(x.size()) - 1;
            };
            std::vector<idx> rim;
            for (int k = 0; k < n; ++k) rim.push_back(at(1, k));
            for (int k = 0; k < n; ++k)
            {
                const idx a = rim[static_cast<std::size_t>(k)], b = rim[static_cast<std::size_t>((k + 1) % n)];
                if (!quad[static_cast<std::size_t>(k)])
                {
                    cells.push_back({a, b, 0});
                    owners.push_back(k);
                    continue;
                }
                std::array<idx, 4> q{0, a, at(1.6, k + 0.5), b};
                const unsigned first = random() % 4;
                for (unsigned c = 0; c < 4; ++c)
                {
                    const auto corner = [&](unsigned i) { return q[(first + c + i) % 4]; };
                    cells.push_back({corner(0), corner(1), corner(3)});
                    owners.push_back(k);
                }
            }
            const auto c = certify<2>(cells, x, {}, 16, owners);
            REQUIRE(c.flipped == 0);
            CHECK(c.branch_ids == (times == 1 ? std::vector<idx>() : std::vector<idx>{0}));
        }
    }
}
