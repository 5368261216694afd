// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/files/surface/surface_file.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
{

/// Gives the corners of faces that have no texture coordinate one, where others of the face have: a face has them at
/// all corners or at none. Such corners lie on flat triangles of a polygon, so they are interpolated between those
/// before and after them, by arc length along the face; a corner at the position of one of these gets the same.
/// texcoords: one per corner of `faces`, into uv; -1: none. What is new is appended to uv.
/// points:    one per vertex
inline void complete_texcoords(const file_faces& faces, std::span<const vec3> points, std::vector<idx>& texcoords,
                               std::vector<vec2>& uv)
{
    std::size_t first = 0;
    for (const idx size : faces.sizes)
    {
        const auto n = static_cast<std::size_t>(size);
        const std::span<idx> some(texcoords.data() + first, n);
        const std::span<const idx> corners(faces.corners.data() + first, n);
        first += n;
        const auto known =
            static_cast<std::size_t>(std::count_if(some.begin(), some.end(), [](idx t) { return t >= 0; }));
        if (known == 0 || known == n) continue;
        const auto way = [&](std::size_t k) // from corner k to the next; 0 to what is not there
        {
            const auto a = static_cast<std::size_t>(corners[k % n]), b = static_cast<std::size_t>(corners[(k + 1) % n]);
            const double length = std::max(a, b) < points.size() ? glm::length(points[b] - points[a]) : 0;
            return std::isfinite(length) ? length : 0;
        };
        std::size_t k = 0; // a corner that has one
        while (some[k] < 0) ++k;
        for (const std::size_t last = k + n; k < last;)
        {
            std::size_t next = k + 1;
            double whole = way(k), gone = 0;
            for (; some[next % n] < 0; ++next) whole += way(next);
            const idx a = some[k % n], b = some[next % n];
            for (std::size_t i = k + 1; i < next; ++i)
            {
                gone += way(i - 1);
                idx& t = some[i % n];
                t = gone == 0 ? a : b;
                if (gone == 0 || gone >= whole || a == b) continue;
                t = static_cast<idx>(uv.size());
                const double share = gone / whole;
                uv.push_back((1 - share) * uv[static_cast<std::size_t>(a)] + share * uv[static_cast<std::size_t>(b)]);
            }
            k = next;
        }
    }
}

} // namespace taut::io::impl
