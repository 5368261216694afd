// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <taut/io/surface_file.hpp>

namespace taut::io
{

/// Gives the corners of faces that have no texture coordinate one, where others of the face have: a face has them at
/// all corners or at none. Such corners lie on flat triangles of a polygon, so they get what lies between those before
/// and after them, by the way along the face; a corner at the place of one of these gets the same.
/// texcoords: one a corner of `faces`, into uv; -1: none. What is new is appended to uv.
/// points:    one a vertex. Throws parameter_error if texcoords has another size.
inline void complete_texcoords(const file_faces& faces, std::span<const vec3> points, std::vector<idx>& texcoords,
                               std::vector<vec2>& uv)
{
    if (texcoords.size() != faces.corners.size())
        throw parameter_error("texcoords", std::to_string(texcoords.size()) + " for " +
                                               std::to_string(faces.corners.size()) +
                                               " corners of faces; give one a corner");
    std::size_t first = 0;
    for (const idx size : faces.sizes)
    {
        const auto n = static_cast<std::size_t>(size);
        const auto texcoord = [&](std::size_t k) -> idx& { return texcoords[first + k % n]; };
        const auto way = [&](std::size_t k)
        {
            const auto point = [&](std::size_t i)
            { return points[static_cast<std::size_t>(faces.corners[first + i % n])]; };
            return glm::length(point(k + 1) - point(k));
        };
        std::size_t from = 0; // a corner that has one
        while (from < n && texcoord(from) < 0) ++from;
        for (std::size_t k = from; from < n && k < from + n;)
        {
            std::size_t next = k + 1;
            double whole = way(k);
            for (; texcoord(next) < 0; ++next) whole += way(next);
            const idx a = texcoord(k), b = texcoord(next);
            double gone = 0;
            for (std::size_t i = k + 1; i < next; ++i)
            {
                gone += way(i - 1);
                if (gone == 0 || gone >= whole || a == b)
                    texcoord(i) = gone == 0 ? a : b;
                else
                {
                    const double t = gone / whole;
                    texcoord(i) = static_cast<idx>(uv.size());
                    uv.push_back((1 - t) * uv[static_cast<std::size_t>(a)] + t * uv[static_cast<std::size_t>(b)]);
                }
            }
            k = next;
        }
        first += n;
    }
}

} // namespace taut::io
