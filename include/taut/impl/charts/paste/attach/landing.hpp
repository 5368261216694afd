// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/similarity_transform.hpp>
#include <taut/impl/charts/paste/surface/polygon_filling.hpp>
#include <taut/impl/charts/paste/surface/surface_tree.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/paste.hpp>
#include <taut/rigid_motion.hpp>

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

/// The attempts at a landing, one after the other.
class landing_attempts
{
public:
    landing_attempts(const feature& f, const landing_place& place, double scale, double turn)
        : feature_(f),
          place_(place),
          onto_(place.region.surface.points()[static_cast<std::size_t>(place.centre)]),
          l_{.transform = {f.centre, onto_,
                           rotation_about(place.normal, turn) * rotation_between(f.normal, place.normal), scale},
             .uv = {},
             .on_target = {},
             .way = {}},
          n_(f.region.rim.size()),
          e1_(glm::normalize(glm::cross(std::abs(place.normal.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0), place.normal))),
          e2_(glm::cross(place.normal, e1_))
    {
        l_.uv.resize(n_);
        l_.on_target.resize(n_);
    }

    /// Points of the surface that are nearest to those of the rim, which is moved along the normal until it is as far
    /// above as below.
    bool project()
    {
        const auto& surface = place_.region.surface;
        const surface_tree tree(surface.points(), surface.cells());
        for (int round = 0; round < 4; ++round)
        {
            double above = 0;
            for (std::size_t i = 0; i < n_; ++i)
            {
                const auto near = tree.nearest(rim(i));
                l_.on_target[i] = near.of(surface.cells(), surface.points());
                l_.uv[i] = near.of(surface.cells(), place_.uv);
                above += glm::dot(rim(i) - l_.on_target[i], place_.normal) / static_cast<double>(n_);
            }
            if (round < 3) l_.transform.to -= above * place_.normal;
        }
        l_.way = "projected";
        return fits(place_, l_.uv);
    }

    /// The tangent plane in the map: a rotation and a shift, fitted near the centre. What follows is laid in it.
    void flatten()
    {
        const auto& surface = place_.region.surface;
        std::vector<vec2> tangent, mapped;
        for (std::size_t v = 0; v < surface.points().size(); ++v)
            if (glm::distance(surface.points()[v], onto_) <= l_.transform.scale * feature_.radius)
            {
                tangent.push_back(flat(surface.points()[v]));
                mapped.push_back(place_.uv[v]);
            }
        to_map_ = fit_rigid_motion(tangent, mapped);
        to_map_.to = place_.uv[static_cast<std::size_t>(place_.centre)];
        to_map_.from = vec2(0.0);
        for (const vec2& p : place_.uv) in_plane_.emplace_back(p, 0.0);
        map_tree_.emplace(in_plane_, surface.cells());
    }

    bool lay()
    {
        for (std::size_t i = 0; i < n_; ++i) l_.uv[i] = to_map_(flat(rim(i)));
        return lands("laid");
    }

    bool smooth()
    {
        for (int round = 0; round < 40; ++round)
        {
            const auto before = l_.uv;
            for (std::size_t i = 0; i < n_; ++i)
                l_.uv[i] = 0.5 * before[i] + 0.25 * (before[(i + n_ - 1) % n_] + before[(i + 1) % n_]);
            if (round % 4 == 3 && lands("smoothed")) return true;
        }
        return false;
    }

    /// A circle of the area of the rim, or of a hundredth of the square of its length where that is more.
    bool encircle()
    {
        double length = 0, area = 0;
        std::vector<double> along;
        for (std::size_t i = 0; i < n_; ++i)
        {
            const vec2 a = flat(rim(i)), b = flat(rim((i + 1) % n_));
            along.push_back(length);
            length += glm::distance(rim(i), rim((i + 1) % n_));
            area += (a.x * b.y - a.y * b.x) / 2;
        }
        const double radius = std::sqrt(std::max(area, 0.01 * length * length) / std::numbers::pi);
        const vec2 first = flat(rim(0));
        const double start = std::atan2(first.y, first.x);
        for (std::size_t i = 0; i < n_; ++i)
        {
            const double a = start + 2 * std::numbers::pi * along[i] / length;
            l_.uv[i] = to_map_(radius * vec2(std::cos(a), std::sin(a)));
        }
        return lands("circle");
    }

    landing found() { return std::move(l_); }

private:
    vec3 rim(std::size_t i) const
    {
        return l_.transform(feature_.region.surface.points()[static_cast<std::size_t>(feature_.region.rim[i])]);
    }
    vec2 flat(const vec3& p) const { return {glm::dot(p - onto_, e1_), glm::dot(p - onto_, e2_)}; }

    bool lands(const char* way)
    {
        l_.way = way;
        if (!fits(place_, l_.uv)) return false;
        const auto& surface = place_.region.surface;
        for (std::size_t i = 0; i < n_; ++i)
            l_.on_target[i] = map_tree_->nearest(vec3(l_.uv[i], 0.0)).of(surface.cells(), surface.points());
        return true;
    }

    const feature& feature_;
    const landing_place& place_;
    vec3 onto_;
    landing l_;
    std::size_t n_;
    vec3 e1_, e2_; ///< of the tangent plane
    rigid_motion<2> to_map_;
    std::vector<vec3> in_plane_; ///< the map
    std::optional<surface_tree> map_tree_;
};

/// Maps the rim of a feature to the target. Tried in this order: projection of each point to the nearest one of the
/// surface; the rim projected to its base, in the map (as an exponential map), then smoothed; a circle of its area.
/// Throws paste_error where none is a simple polygon within the map.
inline landing land(const feature& f, const landing_place& place, double scale, double turn)
{
    landing_attempts attempts(f, place, scale, turn);
    if (attempts.project()) return attempts.found();
    attempts.flatten();
    if (attempts.lay() || attempts.smooth() || attempts.encircle()) return attempts.found();
    throw paste_error(
        "the rim of the feature does not fit on the surface around the target vertex; choose another vertex, a "
        "smaller scale or a larger reach");
}

} // namespace taut::impl
