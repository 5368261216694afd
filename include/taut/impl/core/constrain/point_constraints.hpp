// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/mesh/order.hpp>

namespace taut::impl
{

/// Spring with a stiffness per coordinate: it adds the sum over k of stiffness[k] (x - target)[k]^2.
template <int D>
struct directed_spring
{
    idx vertex;
    vec<D> target, stiffness;
};

/// The same in all coordinates.
template <int D>
std::vector<directed_spring<D>> directed(const std::vector<spring<D>>& springs)
{
    std::vector<directed_spring<D>> all;
    for (const spring<D>& s : springs) all.push_back({s.vertex, s.target, vec<D>(s.weight)});
    return all;
}

/// Constraints of single vertices other than pins, which are eliminated by the layout: single fixed coordinates,
/// springs, and sliding vertices. In units of the map.
template <int D>
struct point_constraints
{
    fixed_marks<D> held;                     ///< one per vertex, or none
    std::vector<directed_spring<D>> springs; ///< springs, whose energy is added to the mean energy
    std::vector<slide<D>> slides{};          ///< at most one per vertex

    bool empty() const { return held.empty() && springs.empty() && slides.empty(); }

    /// Renumbers the vertices.
    point_constraints renumbered(const permutation& p) const
    {
        point_constraints r;
        if (!held.empty()) r.held = fixed_marks<D>(p.apply(held.bits()));
        for (directed_spring<D> s : springs)
        {
            s.vertex = p.old_to_new[static_cast<std::size_t>(s.vertex)];
            r.springs.push_back(s);
        }
        for (slide<D> s : slides)
        {
            s.vertex = p.old_to_new[static_cast<std::size_t>(s.vertex)];
            r.slides.push_back(s);
        }
        return r;
    }

    /// Scales the constraints to a map with lengths multiplied by `factor`.
    point_constraints scaled(double factor) const
    {
        point_constraints r = *this;
        for (auto& s : r.springs)
        {
            s.target *= factor;
            s.stiffness /= factor * factor;
        }
        return r;
    }

    /// One flag per vertex: true if it has any.
    std::vector<bool> touched(std::size_t vertices) const
    {
        std::vector<bool> any(vertices, false);
        for (std::size_t v = 0; v < held.size(); ++v) any[v] = held.any(v);
        for (const auto& s : springs) any[static_cast<std::size_t>(s.vertex)] = true;
        for (const auto& s : slides) any[static_cast<std::size_t>(s.vertex)] = true;
        return any;
    }
};

} // namespace taut::impl
