// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/edit/feature.hpp>
#include <taut/impl/edit/paste_error.hpp>
#include <taut/impl/edit/similarity_transform.hpp>
#include <taut/impl/edit/surface/polygon_filling.hpp>
#include <taut/impl/edit/surface/surface_tree.hpp>
#include <taut/impl/measure/rigid_motion.hpp>

namespace taut::impl
{

/// Neighbourhood of a point of the target, mapped to the plane.
struct landing_place
{
    surface_region region;
    std::vector<vec2> uv; ///< one per vertex of the region
    idx centre;           ///< in numbers of the region
    vec3 normal;          ///< mean over what the feature will cover, of length 1
};

/// Image of the rim of a feature on the target.
struct landing
{
    similarity_transform transform; ///< of the feature
    std::vector<vec2> uv;           ///< of the rim, in the map of the place: a simple polygon within it
    std::vector<vec3> on_target;    ///< the same points in space
    std::string way;                ///< how they were found
};

inline std::vector<vec2> rim_of(const landing_place& place)
{
    std::vector<vec2> rim;
    for (const idx v : place.region.rim) rim.push_back(place.uv[static_cast<std::size_t>(v)]);
    return rim;
}

/// Returns whether a polygon is simple, counter-clockwise and within the map of a place.
inline bool fits(const landing_place& place, std::span<const vec2> polygon)
{
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        area += a.x * b.y - a.y * b.x;
    }
    auto x = rim_of(place);
    const bool within = encloses(x, polygon[0]);
    std::vector<std::vector<idx>> loops(2);
    for (std::size_t i = 0; i < x.size(); ++i) loops[0].push_back(static_cast<idx>(i));
    for (const vec2& p : polygon)
    {
        loops[1].push_back(static_cast<idx>(x.size()));
        x.push_back(p);
    }
    return area > 0 && within && boundary_crossings(loops, x) == 0;
}

/// Maps the rim of a feature to the target. Tried in this order: projection of each point to the nearest one of the
/// surface; the rim projected to its base, in the map (as an exponential map), then smoothed; a circle of its area.
/// Throws paste_error where none is a simple polygon within the map.
inline landing land(const feature& f, const landing_place& place, double scale, double turn)
{
    const auto& surface = place.region.surface;
    const vec3 onto = surface.points()[static_cast<std::size_t>(place.centre)];
    const mat3 rotation = rotation_about(place.normal, turn) * rotation_between(f.normal, place.normal);
    landing l{.transform = {f.centre, onto, rotation, scale}, .uv = {}, .on_target = {}, .way = {}};
    const auto rim = [&](std::size_t i)
    { return l.transform(f.region.surface.points()[static_cast<std::size_t>(f.region.rim[i])]); };
    const std::size_t n = f.region.rim.size();
    l.uv.resize(n);
    l.on_target.resize(n);

    const surface_tree tree(surface.points(), surface.cells());
    for (int round = 0; round < 4; ++round) // along the normal, until the rim is as far above as below
    {
        double above = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            const auto near = tree.nearest(rim(i));
            l.on_target[i] = near.of(surface.cells(), surface.points());
            l.uv[i] = near.of(surface.cells(), place.uv);
            above += glm::dot(rim(i) - l.on_target[i], place.normal) / static_cast<double>(n);
        }
        if (round < 3) l.transform.to -= above * place.normal;
    }
    l.way = "projected";
    if (fits(place, l.uv)) return l;

    // The tangent plane in the map: a rotation and a shift, fitted near the centre.
    const vec3 e1 =
        glm::normalize(glm::cross(std::abs(place.normal.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0), place.normal));
    const vec3 e2 = glm::cross(place.normal, e1);
    const auto flat = [&](const vec3& p) { return vec2(glm::dot(p - onto, e1), glm::dot(p - onto, e2)); };
    std::vector<vec2> tangent, mapped;
    for (std::size_t v = 0; v < surface.points().size(); ++v)
        if (glm::distance(surface.points()[v], onto) <= scale * f.radius)
        {
            tangent.push_back(flat(surface.points()[v]));
            mapped.push_back(place.uv[v]);
        }
    auto to_map = fit_rigid_motion(tangent, mapped);
    to_map.to = place.uv[static_cast<std::size_t>(place.centre)];
    to_map.from = vec2(0.0);
    std::vector<vec3> in_plane;
    for (const vec2& p : place.uv) in_plane.emplace_back(p, 0.0);
    const surface_tree map_tree(in_plane, surface.cells());
    const auto lay = [&](const char* way)
    {
        l.way = way;
        if (!fits(place, l.uv)) return false;
        for (std::size_t i = 0; i < n; ++i)
            l.on_target[i] = map_tree.nearest(vec3(l.uv[i], 0.0)).of(surface.cells(), surface.points());
        return true;
    };
    for (std::size_t i = 0; i < n; ++i) l.uv[i] = to_map(flat(rim(i)));
    if (lay("laid")) return l;
    for (int round = 0; round < 40; ++round)
    {
        const auto before = l.uv;
        for (std::size_t i = 0; i < n; ++i)
            l.uv[i] = 0.5 * before[i] + 0.25 * (before[(i + n - 1) % n] + before[(i + 1) % n]);
        if (round % 4 == 3 && lay("smoothed")) return l;
    }

    double length = 0, area = 0;
    std::vector<double> along;
    for (std::size_t i = 0; i < n; ++i)
    {
        const vec2 a = flat(rim(i)), b = flat(rim((i + 1) % n));
        along.push_back(length);
        length += glm::distance(rim(i), rim((i + 1) % n));
        area += (a.x * b.y - a.y * b.x) / 2;
    }
    const double radius = std::sqrt(std::max(area, 0.01 * length * length) / std::numbers::pi);
    const vec2 first = flat(rim(0));
    const double start = std::atan2(first.y, first.x);
    for (std::size_t i = 0; i < n; ++i)
    {
        const double a = start + 2 * std::numbers::pi * along[i] / length;
        l.uv[i] = to_map(radius * vec2(std::cos(a), std::sin(a)));
    }
    if (lay("circle")) return l;
    throw paste_error(
        "the rim of the feature does not fit on the surface around the target vertex; choose another vertex, a "
        "smaller scale or a larger reach");
}

} // namespace taut::impl
