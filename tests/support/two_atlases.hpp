// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <taut/bake.hpp>
#include <taut/types.hpp>

namespace taut::test
{

/// A curved patch over the unit square, cut into two charts left and right in one atlas, and into two charts below and
/// above in the other, each turned, of another scale; one chart of each may be mirrored.
struct two_atlases
{
    /// A chart: x -> origin + scale * turned(x), with x the place in the unit square.
    struct chart
    {
        vec2 origin, u, v;
        vec2 operator()(const vec2& x) const { return origin + x.x * u + x.y * v; }
        vec2 back(const vec2& y) const
        {
            const vec2 d = y - origin;
            const double det = u.x * v.y - u.y * v.x;
            return {(d.x * v.y - d.y * v.x) / det, (u.x * d.y - u.y * d.x) / det};
        }
    };

    explicit two_atlases(int n = 8, bool mirrored = false)
    {
        // Both charts of each lie side by side, left and right of the middle, with a gap.
        from = {chart{{0.05, 0.05}, {0.82, 0.06}, {-0.03, 0.88}}, chart{{0.95, -0.39}, {-0.02, 0.88}, {-0.42, 0.02}}};
        to = {chart{{0.46, 0.04}, {0.0, 0.9}, {-0.8, 0.0}}, chart{{0.55, 0.91}, {0.02, -0.85}, {0.76, 0.02}}};
        to[1].origin -= 0.45 * to[1].v;
        if (mirrored) to[0] = chart{{0.06, 0.04}, {0.0, 0.9}, {0.8, 0.0}};
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i)
            {
                const vec2 x(i / static_cast<double>(n), j / static_cast<double>(n));
                points.emplace_back(x.x, x.y, 0.2 * std::sin(3 * x.x) * std::cos(2 * x.y));
                flat.push_back(x);
            }
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                const idx a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
                for (const std::array<idx, 3>& t : {std::array<idx, 3>{a, b, d}, std::array<idx, 3>{a, d, c}})
                {
                    const chart& old = from[2 * i < n ? 0 : 1];
                    const chart& next = to[2 * j < n ? 0 : 1];
                    std::array<vec2, 3> x, y;
                    for (std::size_t k = 0; k < 3; ++k)
                    {
                        x[k] = old(flat[static_cast<std::size_t>(t[k])]);
                        y[k] = next(flat[static_cast<std::size_t>(t[k])]);
                    }
                    triangles.push_back(t);
                    old_uv.push_back(x);
                    new_uv.push_back(y);
                }
            }
    }

    /// The old texture of a function of the unit square: f(x) gives the channels; charts go on beyond their borders.
    template <class F>
    texture old_texture(idx width, idx height, idx channels, F f) const
    {
        texture image{width, height, channels, {}};
        for (idx j = 0; j < height; ++j)
            for (idx i = 0; i < width; ++i)
            {
                const vec2 uv((i + 0.5) / width, (j + 0.5) / height);
                const auto value = f(from[uv.x < 0.5 ? 0 : 1].back(uv), uv.x < 0.5 ? 0 : 1);
                for (idx c = 0; c < channels; ++c)
                    image.texels.push_back(static_cast<float>(value[static_cast<std::size_t>(c)]));
            }
        return image;
    }

    /// Calls f(triangle, weights of its corners) for places on the surface.
    template <class F>
    void for_places(int count, F f) const
    {
        std::minstd_rand dice(7);
        const auto number = [&] { return static_cast<double>(dice()) / 2147483647.0; };
        for (int n = 0; n < count; ++n)
        {
            const auto t = static_cast<std::size_t>(number() * 0.999 * static_cast<double>(triangles.size()));
            double u = number(), v = number();
            if (u + v > 1)
            {
                u = 1 - u;
                v = 1 - v;
            }
            f(t, vec3(1 - u - v, u, v));
        }
    }

    template <class Corners>
    static auto at(const Corners& corners, const vec3& w)
    {
        return w.x * corners[0] + w.y * corners[1] + w.z * corners[2];
    }

    vec2 place(std::size_t t, const vec3& w) const
    {
        vec2 x(0.0);
        for (int k = 0; k < 3; ++k)
            x += w[k] * flat[static_cast<std::size_t>(triangles[t][static_cast<std::size_t>(k)])];
        return x;
    }

    std::array<chart, 2> from, to;
    std::vector<vec3> points;
    std::vector<vec2> flat; ///< the place of each vertex in the unit square
    std::vector<std::array<idx, 3>> triangles;
    std::vector<std::array<vec2, 3>> old_uv, new_uv;
};

} // namespace taut::test
