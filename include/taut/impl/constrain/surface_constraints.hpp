// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/constrain/point_constraints.hpp>
#include <taut/impl/constrain/untangle_problem.hpp>
#include <taut/impl/measure/planar_size.hpp>
#include <taut/impl/measure/similarity.hpp>
#include <taut/impl/mesh/boundary.hpp>

namespace taut::impl
{

/// Fixed coordinates of a map of a surface: those of a fixed boundary and of pins. Lengths of maps are `unit` times
/// those of the constraints.
class surface_constraints
{
public:
    /// fixed: the vertices of a fixed boundary; none where it is free. Throws parameter_error for constraints of
    /// another mesh; constraint_error (not_finite) for targets that are too far away in lengths of `unit`.
    surface_constraints(constraints<triangle> wanted, std::size_t vertices, std::span<const idx> fixed, double unit)
        : wanted_(std::move(wanted)), free_boundary_(fixed.empty()), unit_(unit)
    {
        for (const auto& [v, pin] : wanted_.pins()) require(v, vertices);
        for (const auto& s : wanted_.springs()) require(s.vertex, vertices);
        wanted_.require_near(unit);
        if (free_boundary_ && wanted_.pins().empty()) return;
        marks_ = fixed_marks<2>(vertices);
        for (const idx v : fixed) marks_[static_cast<std::size_t>(v)] = marks_.every;
        for (const auto& [v, pin] : wanted_.pins()) marks_[static_cast<std::size_t>(v)] |= pin.held;
    }

    /// Checks that these unreferenced vertices, ascending, have no constraints. Throws constraint_error
    /// (unused_vertex).
    void require_used(std::span<const idx> unused) const { wanted_.require_used(unused); }

    /// Flags of vertices with constraints, one per vertex, which coarser surfaces should contain. Numerous springs are
    /// left out; those whose vertices happen to be there suffice.
    std::vector<bool> touched(std::size_t vertices) const
    {
        std::vector<bool> any(vertices, false);
        for (std::size_t v = 0; v < marks_.size(); ++v) any[v] = marks_.any(v);
        const auto springs = wanted_.springs();
        if (springs.size() <= vertices / 10)
            for (const auto& s : springs) any[static_cast<std::size_t>(s.vertex)] = true;
        return any;
    }

    /// Springs of stiffness 1 from pinned vertices to their targets, along the fixed coordinates; of the vertices for
    /// which `left_out` has no flag.
    std::vector<directed_spring<2>> pull(const std::vector<bool>& left_out) const
    {
        std::vector<directed_spring<2>> springs;
        for (const auto& [v, pin] : wanted_.pins())
            if (!left_out[static_cast<std::size_t>(v)])
                springs.push_back({v, pin.value * unit_, vec2(pin.held & 1u, pin.held >> 1u & 1u)});
        return springs;
    }

    /// Centre of the targets of pinned vertices; the origin without any.
    vec2 centre() const
    {
        std::vector<vec2> places;
        for (const auto& [v, p] : wanted_.pins())
            if (p.held == marks_.every) places.push_back(p.value * unit_);
        return places.empty() ? vec2(0) : impl::bounding_square(places).centre;
    }

    bool constrained() const { return !wanted_.empty(); }
    bool pinned() const { return !wanted_.pins().empty(); }

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
        for (const auto& [v, p] : wanted_.pins())
            if (p.held == marks_.every) anchors.push_back({uv[static_cast<std::size_t>(v)], p.value * unit_});
        if (anchors.size() < 2)
        {
            double heaviest = 0;
            for (const auto& s : wanted_.springs()) heaviest = std::max(heaviest, s.weight);
            for (const auto& s : wanted_.springs())
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

    /// Sets fixed coordinates to their targets, in lengths of `unit` times the user's.
    void impose(std::vector<vec2>& uv, double unit) const
    {
        for (const auto& [v, pin] : wanted_.pins())
            for (int k = 0; k < 2; ++k)
                if ((pin.held >> k & 1u) != 0) uv[static_cast<std::size_t>(v)][k] = pin.value[k] * unit;
    }

    /// The points of a map at the vertices of constraints::pins(), in their order.
    std::vector<vec2> pinned_points(const std::vector<vec2>& uv) const
    {
        std::vector<vec2> points;
        for (const auto& [v, pin] : wanted_.pins()) points.push_back(uv[static_cast<std::size_t>(v)]);
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

    /// Constraints other than pins, for a map whose origin is `centre`.
    point_constraints<2> beyond_pins(const vec2& centre) const
    {
        point_constraints<2> r;
        if (auto alone = marks_.without_pinned(); alone.any()) r.held = std::move(alone);
        for (const auto& s : wanted_.springs()) r.springs.push_back({s.vertex, s.target, vec2(s.weight)});
        r = r.scaled(unit_);
        for (auto& s : r.springs) s.target -= centre;
        return r;
    }

private:
    /// True if there are pins and all are at their targets; a similarity could only add rounding.
    bool obeys(const std::vector<vec2>& uv) const
    {
        for (const auto& [v, pin] : wanted_.pins())
            for (int k = 0; k < 2; ++k)
                if ((pin.held >> k & 1u) != 0 && uv[static_cast<std::size_t>(v)][k] != pin.value[k] * unit_)
                    return false;
        return !wanted_.pins().empty();
    }

    static void require(idx v, std::size_t vertices)
    {
        if (v >= 0 && static_cast<std::size_t>(v) < vertices) return;
        throw parameter_error("constraints", "vertex " + std::to_string(v) + " is not one of this mesh's " +
                                                 std::to_string(vertices) +
                                                 "; make them with the mesh that is parameterized");
    }

    constraints<triangle> wanted_;
    bool free_boundary_;
    double unit_;
    fixed_marks<2> marks_;
};

} // namespace taut::impl
