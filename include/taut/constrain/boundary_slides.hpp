// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/constrain/constraints.hpp>
#include <taut/constrain/slide.hpp>
#include <taut/mesh/cell_corners.hpp>

namespace taut
{

/// How the vertices of a boundary may move without changing its shape.
template <class Element>
struct boundary_motion
{
    taut::constraints<Element> pins;               ///< corners, and coordinates that flat sides along the axes hold
    std::vector<slide<Element::dimension>> slides; ///< in other flat sides, and along straight creases between them
};

namespace detail
{

/// Directions that a few unit vectors span, one after the other as they come.
template <int D>
class span_of_normals
{
public:
    /// tolerance: the sine of the angle up to which directions count as one
    void add(const vec<D>& unit, double tolerance)
    {
        vec<D> rest = unit;
        for (int k = 0; k < rank_; ++k) rest -= glm::dot(rest, basis_[k]) * basis_[k];
        const double length = glm::length(rest);
        if (rank_ < D && length > tolerance) basis_[rank_++] = rest / length;
    }
    int rank() const { return rank_; }
    const vec<D>& operator[](int k) const { return basis_[k]; }

private:
    vec<D> basis_[D]{};
    int rank_ = 0;
};

/// The axis that a direction is exactly along, or -1.
template <int D>
int axis_of(const vec<D>& direction)
{
    int axis = -1, others = 0;
    for (int k = 0; k < D; ++k)
        if (direction[k] != 0) axis = k, ++others;
    return others == 1 ? axis : -1;
}

} // namespace detail

/// The motions that keep the boundary of a mesh: a vertex in a flat part of it moves in its plane, one on a straight
/// crease (in the plane, a straight outline) along it, all others are pinned. Held coordinates hold bit for bit.
///
/// tolerance: sine of the angle up to which normals count as equal; owners: as for boundary_facets()
template <class Element>
boundary_motion<Element> sliding_boundary(const mesh<Element>& m, double tolerance = 1e-4,
                                          std::span<const idx> owners = {})
{
    constexpr int D = Element::dimension;
    std::vector<detail::span_of_normals<D>> normals(m.points().size());
    for (const auto& facet : boundary_facets(m, owners))
    {
        const auto at = [&](std::size_t k) { return vec<D>(m.points()[static_cast<std::size_t>(facet[k])]); };
        vec<D> normal;
        if constexpr (D == 2)
            normal = vec2(at(1).y - at(0).y, at(0).x - at(1).x);
        else
            normal = glm::cross(at(1) - at(0), at(2) - at(0));
        const double length = glm::length(normal);
        if (!(length > 0)) continue;
        for (const idx v : facet) normals[static_cast<std::size_t>(v)].add(normal / length, tolerance);
    }
    boundary_motion<Element> motion{taut::constraints<Element>(m), {}};
    for (std::size_t v = 0; v < normals.size(); ++v)
    {
        const auto& n = normals[v];
        const auto id = static_cast<idx>(v);
        const vec<D> here(m.points()[v]);
        if (n.rank() == D)
            motion.pins.pin(id, here);
        else if (n.rank() == 1)
        {
            if (const int axis = detail::axis_of<D>(n[0]); axis >= 0)
                motion.pins.pin(id, axis, here[axis]);
            else
                motion.slides.push_back(slide<D>::across(id, n[0]));
        }
        if constexpr (D == 3)
            if (n.rank() == 2)
            {
                const vec3 along = glm::cross(n[0], n[1]);
                const int axis = detail::axis_of<3>(along);
                if (axis < 0)
                    motion.slides.push_back(slide<3>::along(id, along));
                else
                    for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) motion.pins.pin(id, k, here[k]);
            }
    }
    return motion;
}

} // namespace taut
