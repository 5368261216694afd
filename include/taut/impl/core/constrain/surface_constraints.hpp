// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/constrain/fixed_coordinates.hpp>
#include <taut/impl/core/constrain/point_constraints.hpp>
#include <taut/impl/core/measure/planar_size.hpp>
#include <taut/impl/core/measure/similarity.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Constraints of a map of a surface: fixed coordinates, which are those of pins and of a fixed boundary, and springs.
/// Lengths of maps are `unit` times those of the constraints.
class surface_constraints
{
public:
    /// fixed: the vertices of a fixed boundary; none where it is free. Throws parameter_error for constraints of
    /// another mesh; constraint_error (not_finite) for targets that are too far away in lengths of `unit`, and
    /// (unused_vertex) for constraints of the vertices `unused`, ascending, that no triangle has.
    surface_constraints(const constraints<triangle>& wanted, std::size_t vertices, std::span<const idx> fixed,
                        std::span<const idx> unused, double unit)
        : free_boundary_(fixed.empty()), unit_(unit)
    {
        for (const auto& [v, pin] : wanted.pins()) require(v, vertices);
        for (const auto& s : wanted.springs()) require(s.vertex, vertices);
        wanted.require_near(unit);
        wanted.require_used(unused);
        springs_ = wanted.springs();
        if (!wanted.pins().empty())
        {
            pins_ = {std::vector<vec2>(vertices), {}};
            pins_.take(wanted);
            marks_ = pins_.marks();
        }
        else if (!free_boundary_)
            marks_ = fixed_marks<2>(vertices);
        for (const idx v : fixed) marks_[static_cast<std::size_t>(v)] = marks_.every;
    }

    /// Flags of vertices with constraints, one per vertex, which coarser surfaces should contain. Numerous springs are
    /// left out; those whose vertices happen to be there suffice.
    std::vector<bool> touched(std::size_t vertices) const
    {
        std::vector<bool> any(vertices, false);
        for (std::size_t v = 0; v < marks_.size(); ++v) any[v] = marks_.any(v);
        if (springs_.size() <= vertices / 10)
            for (const auto& s : springs_) any[static_cast<std::size_t>(s.vertex)] = true;
        return any;
    }

    /// Springs of stiffness 1 from pinned vertices to their targets, along the fixed coordinates; of the vertices for
    /// which `left_out` has no flag.
    std::vector<directed_spring<2>> pull(const std::vector<bool>& left_out) const
    {
        std::vector<directed_spring<2>> springs;
        each_pinned(
            [&](std::size_t v)
            {
                const auto held = pins_.marks()[v];
                if (!left_out[v]) springs.push_back({static_cast<idx>(v), target(v), vec2(held & 1u, held >> 1u & 1u)});
            });
        return springs;
    }

    /// Centre of the targets of pinned vertices; the origin without any.
    vec2 centre() const
    {
        std::vector<vec2> places;
        each_pinned(
            [&](std::size_t v)
            {
                if (pins_.marks().all(v)) places.push_back(target(v));
            });
        return places.empty() ? vec2(0) : impl::bounding_square(places).centre;
    }

    bool constrained() const { return pinned() || !springs_.empty(); }
    bool pinned() const { return !pins_.marks().empty(); }

    /// One per vertex; none if nothing is fixed.
    const fixed_marks<2>& marks() const { return marks_; }

    /// True if the constraints pin every vertex of the boundary.
    bool outline_pinned(const mesh<triangle>& m, const facet_table& sides) const
    {
        if (marks_.empty()) return false;
        for (const auto& loop : boundary_loops(m, sides))
            for (const idx v : loop)
                if (!marks_.all(static_cast<std::size_t>(v))) return false;
        return true;
    }

    /// Moves a map by the similarity that fits the constraints best, if its boundary is free: two or more pinned
    /// vertices; else these and the springs. One vertex translates the map, none leaves it. Targets far from any
    /// similarity, which would shrink the map to nothing, only rotate and translate it.
    void bring_near(std::vector<vec2>& uv) const
    {
        if (!free_boundary_ || obeys(uv)) return;
        std::vector<anchor> anchors;
        each_pinned(
            [&](std::size_t v)
            {
                if (pins_.marks().all(v)) anchors.push_back({uv[v], target(v)});
            });
        if (anchors.size() < 2)
        {
            double heaviest = 0;
            for (const auto& s : springs_) heaviest = std::max(heaviest, s.weight);
            for (const auto& s : springs_)
                if (s.weight > 0)
                    anchors.push_back({uv[static_cast<std::size_t>(s.vertex)], s.target * unit_, s.weight / heaviest});
        }
        if (anchors.empty()) return;
        auto [map, explained] = fit_similarity(anchors);
        const double scale = std::abs(map.turn);
        if (!(scale > 0) || !std::isfinite(scale))
            map.turn = 1;
        else if (explained <= 0.25)
            map.turn /= scale;
        for (vec2& p : uv) p = map(p);
    }

    /// Sets the coordinates of pins to their targets, in lengths of `unit` times the user's.
    void impose(std::vector<vec2>& uv, double unit) const { pins_.impose_scaled(uv, unit); }

    /// The points of a map at the vertices of constraints::pins(), in their order.
    std::vector<vec2> pinned_points(const std::vector<vec2>& uv) const
    {
        std::vector<vec2> points;
        each_pinned([&](std::size_t v) { points.push_back(uv[v]); });
        return points;
    }

    /// Copies fixed coordinates from another map, bit for bit.
    void restore(std::vector<vec2>& uv, const std::vector<vec2>& from) const
    {
        for (std::size_t v = 0; v < marks_.size(); ++v)
            for (int k = 0; k < 2; ++k)
                if (marks_.test(v, k)) uv[v][k] = from[v][k];
    }

    untangle_problem<triangle> problem(const mesh<triangle>& m, std::vector<vec2> uv) const
    {
        return {m, std::move(uv), marks_.empty() ? fixed_marks<2>(m.points().size()) : marks_};
    }

    /// Constraints other than those of vertices that are eliminated, for a map whose origin is `centre`.
    point_constraints<2> beyond_pins(const vec2& centre) const
    {
        auto r = point_constraints<2>{{}, directed(springs_)}.scaled(unit_);
        if (auto alone = marks_.without_pinned(); alone.any()) r.held = std::move(alone);
        for (auto& s : r.springs) s.target -= centre;
        return r;
    }

private:
    vec2 target(std::size_t v) const { return pins_.targets()[v] * unit_; }

    /// Calls visit(v) for each vertex with a pin, ascending.
    template <class Visit>
    void each_pinned(const Visit& visit) const
    {
        for (std::size_t v = 0; v < pins_.marks().size(); ++v)
            if (pins_.marks().any(v)) visit(v);
    }

    /// True if there are pins and all are at their targets; a similarity could only add rounding.
    bool obeys(const std::vector<vec2>& uv) const
    {
        return pinned() && pins_.gap(uv, [this](std::size_t v) { return target(v); }).vertex < 0;
    }

    static void require(idx v, std::size_t vertices)
    {
        if (v >= 0 && static_cast<std::size_t>(v) < vertices) return;
        throw parameter_error("constraints", "vertex " + std::to_string(v) + " is not one of this mesh's " +
                                                 std::to_string(vertices) +
                                                 "; make them with the mesh that is parameterized");
    }

    fixed_coordinates<triangle> pins_; ///< in the user's lengths, so that they are exact; of no map without pins
    fixed_marks<2> marks_;             ///< of pins and of a fixed boundary
    std::vector<spring<2>> springs_;
    bool free_boundary_;
    double unit_;
};

} // namespace taut::impl
