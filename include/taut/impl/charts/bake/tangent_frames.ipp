// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include <taut/bake.hpp>
#include <taut/errors.hpp>
#include <taut/impl/charts/bake/tangent_frames.hpp>
#include <taut/types.hpp>

namespace taut
{

std::vector<std::array<vec3, 3>> smooth_normals(std::span<const vec3> points,
                                                std::span<const std::array<idx, 3>> triangles)
{
    std::vector<vec3> sums(points.size(), vec3(0.0));
    for (const auto& t : triangles)
    {
        const auto x = impl::corners_of(points, t);
        const vec3 n = impl::normalised(glm::cross(x[1] - x[0], x[2] - x[0]));
        for (std::size_t k = 0; k < 3; ++k) sums[static_cast<std::size_t>(t[k])] += impl::corner_angle(x, k) * n;
    }
    std::vector<std::array<vec3, 3>> normals(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            normals[f][k] = impl::normalised(sums[static_cast<std::size_t>(triangles[f][k])], vec3(0, 0, 1));
    return normals;
}

std::vector<corner_tangents> tangent_frames(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                            std::span<const std::array<vec3, 3>> normals,
                                            std::span<const std::array<vec2, 3>> uv)
{
    if (normals.size() != triangles.size()) throw parameter_error("normals", "give three per triangle, one per corner");
    if (uv.size() != triangles.size())
        throw parameter_error("uv", "give three texture coordinates per triangle, one per corner");
    using key = std::tuple<idx, double, double, double, double, double, bool>;
    std::map<key, vec3> sums;
    const auto key_of = [&](std::size_t f, std::size_t k, bool mirrored)
    {
        const vec3& n = normals[f][k];
        const vec2& x = uv[f][k];
        return key{triangles[f][k], n.x, n.y, n.z, x.x, x.y, mirrored};
    };
    std::vector<char> mirrored(triangles.size(), 0);
    for (std::size_t f = 0; f < triangles.size(); ++f)
    {
        const auto x = impl::corners_of(points, triangles[f]);
        const vec2 a = uv[f][1] - uv[f][0], b = uv[f][2] - uv[f][0];
        const double det = a.x * b.y - a.y * b.x;
        mirrored[f] = det < 0;
        if (!(std::abs(det) > 0)) continue;
        const vec3 u = (b.y * (x[1] - x[0]) - a.y * (x[2] - x[0])) / det;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec3& n = normals[f][k];
            sums[key_of(f, k, mirrored[f] != 0)] += impl::corner_angle(x, k) * impl::normalised(u - glm::dot(n, u) * n);
        }
    }
    std::vector<corner_tangents> tangents(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto at = sums.find(key_of(f, k, mirrored[f] != 0));
            const vec3 none = impl::any_across(normals[f][k]);
            const vec3 t = at == sums.end() ? none : impl::normalised(at->second, none);
            tangents[f][k] = vec<4>(t, mirrored[f] != 0 ? -1.0 : 1.0);
        }
    return tangents;
}

} // namespace taut
