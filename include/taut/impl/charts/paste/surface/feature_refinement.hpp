// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/charts/paste/surface/plane_triangulation.hpp>
#include <taut/impl/charts/paste/surface/surface_tree.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// A place where a triangulation of a feature's map misses the feature.
struct missed_place
{
    double distance = 0;
    vec2 uv{0.0};
    vec3 point{0.0}; ///< of the feature
};

/// Refines a triangulation of a feature's map until it is within `tolerance` of the feature, as vertices and middles of
/// edges of both tell, or has `most` points: where it is not, points of the feature are inserted, the farthest first.
class feature_refinement
{
public:
    feature_refinement(const mesh<triangle>& surface, std::span<const vec2> uv, double tolerance)
        : surface_(surface), tolerance_(tolerance), tree_(surface.points(), surface.cells())
    {
        for (const vec2& p : uv) in_plane_.emplace_back(p, 0.0);
        map_tree_.emplace(in_plane_, surface_.cells());
        for (std::size_t v = 0; v < uv.size(); ++v) samples_.push_back({0, uv[v], surface.points()[v]});
        for (const auto& [a, b] : edges_of(surface.cells()))
            samples_.push_back({0, 0.5 * (uv[a] + uv[b]), 0.5 * (surface.points()[a] + surface.points()[b])});
    }

    double distance(const vec3& p) const { return tree_.nearest(p).distance; }

    /// x: places in space of the points of `plane`, which grow with it
    void operator()(plane_triangulation& plane, std::vector<vec3>& x, std::size_t most)
    {
        for (bool more = true; more && x.size() < most;)
        {
            auto missed = missed_by(plane, x);
            add_missing(missed, plane, x);
            std::stable_sort(missed.begin(), missed.end(),
                             [](const auto& a, const auto& b) { return a.distance > b.distance; });
            more = false;
            for (const auto& place : missed)
            {
                if (x.size() >= most) break;
                if (!plane.insert(place.uv)) continue;
                x.push_back(place.point);
                more = true;
            }
        }
    }

private:
    using edge = std::array<std::size_t, 2>;

    static std::set<edge> edges_of(const std::vector<std::array<idx, 3>>& cells)
    {
        std::set<edge> edges;
        for (const auto& t : cells)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
                edges.insert({static_cast<std::size_t>(a), static_cast<std::size_t>(b)});
            }
        return edges;
    }

    /// The farthest sample of the feature from each triangle.
    std::vector<missed_place> missed_by(plane_triangulation& plane, const std::vector<vec3>& x) const
    {
        std::vector<missed_place> farthest(plane.triangles().size());
        for (const auto& sample : samples_)
        {
            const idx f = plane.locate(sample.uv);
            if (f < 0) continue;
            const auto& t = plane.triangles()[static_cast<std::size_t>(f)];
            const auto at = [&](std::size_t k) -> const vec3& { return x[static_cast<std::size_t>(t[k])]; };
            const vec3 w = nearest_weights(sample.point, at(0), at(1), at(2));
            const double d = glm::distance(sample.point, w.x * at(0) + w.y * at(1) + w.z * at(2));
            auto& best = farthest[static_cast<std::size_t>(f)];
            if (d > tolerance_ && d > best.distance) best = {d, sample.uv, sample.point};
        }
        std::erase_if(farthest, [](const auto& place) { return !(place.distance > 0); });
        return farthest;
    }

    /// Edges that are new since the last call and whose middle is not on the feature.
    void add_missing(std::vector<missed_place>& missed, const plane_triangulation& plane, const std::vector<vec3>& x)
    {
        const auto edges = edges_of(plane.triangles());
        std::vector<edge> open;
        std::set_difference(edges.begin(), edges.end(), known_.begin(), known_.end(), std::back_inserter(open));
        std::vector<missed_place> places(open.size());
        parallel_for(open.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t i = begin; i < end; ++i)
                         {
                             const auto [a, b] = open[i];
                             const vec2 uv = 0.5 * (plane.points()[a] + plane.points()[b]);
                             const double d = distance(0.5 * (x[a] + x[b]));
                             if (!(d > tolerance_)) continue;
                             const auto place = map_tree_->nearest(vec3(uv, 0.0));
                             places[i] = {d, uv, place.of(surface_.cells(), surface_.points())};
                         }
                     });
        std::copy_if(places.begin(), places.end(), std::back_inserter(missed),
                     [](const auto& place) { return place.distance > 0; });
        known_ = edges;
    }

    const mesh<triangle>& surface_;
    double tolerance_;
    surface_tree tree_;
    std::vector<vec3> in_plane_; ///< the map of the feature
    std::optional<surface_tree> map_tree_;
    std::vector<missed_place> samples_; ///< of the feature
    std::set<edge> known_;
};

} // namespace taut::impl
