// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>

namespace taut::impl
{

/// Constraints that keep the shape of a boundary: a vertex in a flat part of it moves in its plane, one on a straight
/// crease (in the plane, a straight outline) along it, all others are pinned. Fixed coordinates are met bit for bit.
template <class Element>
struct boundary_motion
{
    taut::constraints<Element> pins;               ///< corners, and coordinates that flat sides along the axes hold
    std::vector<slide<Element::dimension>> slides; ///< in other flat sides, and along straight creases between them
};

/// Orthonormal basis of the span of a few unit vectors, built incrementally.
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

/// Axis that a direction is exactly parallel to, or -1.
template <int D>
int axis_of(const vec<D>& direction)
{
    int axis = -1, others = 0;
    for (int k = 0; k < D; ++k)
        if (direction[k] != 0) axis = k, ++others;
    return others == 1 ? axis : -1;
}

/// Facet of a surface that keeps its shape, with its piece: in the plane an edge of a line. Lines where pieces meet or
/// end keep their shape, too.
struct kept_facet
{
    std::array<idx, 4> vertices{-1, -1, -1, -1}; ///< around; -1 behind the last
    idx piece = 0;

    std::span<const idx> corners() const
    {
        return std::span<const idx>(vertices).first(vertices[2] < 0 ? 2 : vertices[3] < 0 ? 3 : 4);
    }
};

/// Collects the directions in which vertices may not move.
template <class Element>
class kept_directions
{
public:
    static constexpr int D = Element::dimension;

    explicit kept_directions(const mesh<Element>& m) : mesh_(m), normals_(m.points().size()) {}

    void add(std::span<const std::array<idx, D>> facets)
    {
        for (const auto& facet : facets)
        {
            vec<D> normal;
            if constexpr (D == 2)
                normal = across(at(facet[1]) - at(facet[0]));
            else
                normal = glm::cross(at(facet[1]) - at(facet[0]), at(facet[2]) - at(facet[0]));
            for (const idx v : facet) hold(v, normal);
        }
    }

    void add(std::span<const kept_facet> facets)
    {
        // Of each end of a facet, sorted: how many facets have it, of which piece, and whether of one alone.
        struct rim
        {
            std::size_t facets = 0;
            idx piece = -1;
            bool one_piece = true;
        };
        std::map<std::array<idx, 2>, rim> rims;
        const auto for_ends = [&](const kept_facet& facet, const auto& visit)
        {
            const auto v = facet.corners();
            for (std::size_t k = 0; k < v.size(); ++k)
                if (D == 2)
                    visit(std::array<idx, 2>{v[k], v[k]}, k);
                else
                    visit(std::array<idx, 2>{std::min(v[k], v[(k + 1) % v.size()]),
                                             std::max(v[k], v[(k + 1) % v.size()])},
                          k);
        };
        for (const auto& facet : facets)
            for_ends(facet,
                     [&](const std::array<idx, 2>& end, std::size_t)
                     {
                         auto& r = rims[end];
                         r.one_piece = r.one_piece && (r.facets == 0 || r.piece == facet.piece);
                         r.piece = facet.piece;
                         ++r.facets;
                     });
        for (const auto& facet : facets)
        {
            const auto v = facet.corners();
            const std::size_t n = v.size();
            const auto normal = [&](std::size_t k) // at a corner
            {
                if constexpr (D == 2)
                    return across(at(v[1]) - at(v[0]));
                else
                    return glm::cross(at(v[(k + 1) % n]) - at(v[k]), at(v[(k + n - 1) % n]) - at(v[k]));
            };
            for (std::size_t k = 0; k < n; ++k)
                for (const idx corner : v) hold(corner, normal(k)); // a quad may be warped
            for_ends(facet,
                     [&](const std::array<idx, 2>& end, std::size_t k)
                     {
                         const auto& r = rims[end];
                         if (r.facets == 2 && r.one_piece) return;
                         if constexpr (D == 2)
                             hold(v[k], at(v[1]) - at(v[0]));
                         else
                             for (const std::size_t c : {k, (k + 1) % n})
                                 hold(v[c], glm::cross(unit(normal(c)), at(v[(k + 1) % n]) - at(v[k])));
                     });
        }
    }

    boundary_motion<Element> motion() const
    {
        boundary_motion<Element> result{taut::constraints<Element>(mesh_), {}};
        for (std::size_t v = 0; v < normals_.size(); ++v)
        {
            const auto& n = normals_[v];
            const auto id = static_cast<idx>(v);
            const vec<D> here = at(id);
            if (n.rank() == D)
                result.pins.pin(id, here);
            else if (n.rank() == 1)
            {
                if (const int axis = impl::axis_of<D>(n[0]); axis >= 0)
                    result.pins.pin(id, axis, here[axis]);
                else
                    result.slides.push_back(slide<D>::across(id, n[0]));
            }
            if constexpr (D == 3)
                if (n.rank() == 2)
                {
                    const vec3 along = glm::cross(n[0], n[1]);
                    const int axis = impl::axis_of<3>(along);
                    if (axis < 0)
                        result.slides.push_back(slide<3>::along(id, along));
                    else
                        for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) result.pins.pin(id, k, here[k]);
                }
        }
        return result;
    }

private:
    vec<D> at(idx v) const { return vec<D>(mesh_.points()[static_cast<std::size_t>(v)]); }
    static vec2 across(const vec2& edge) { return {edge.y, -edge.x}; }
    static vec<D> unit(const vec<D>& x)
    {
        const double length = glm::length(x);
        return length > 0 ? x / length : vec<D>(0.0);
    }

    void hold(idx v, const vec<D>& direction)
    {
        const vec<D> n = unit(direction);
        if (n != vec<D>(0.0)) normals_[static_cast<std::size_t>(v)].add(n, tolerance_);
    }

    const mesh<Element>& mesh_;
    static constexpr double tolerance_ = 1e-4; ///< sine of the angle up to which a boundary is flat or straight
    std::vector<span_of_normals<D>> normals_;
};

} // namespace taut::impl
