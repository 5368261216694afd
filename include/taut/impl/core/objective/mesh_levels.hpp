// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/make_hierarchy.hpp>
#include <taut/impl/core/hierarchy/make_volume_hierarchy.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/core/mesh/cell_data.hpp>
#include <taut/impl/core/mesh/layout.hpp>
#include <taut/impl/core/sparse/transfer_weights.hpp>

namespace taut::impl
{

/// Mesh in solution order and its coarser levels, with the connectivity and layout of each and the transfers between
/// them. Levels keep the numbering of the finest one, so free vertices are first on each.
template <class Element>
class mesh_levels
{
public:
    /// pinned: one flag per vertex of m, or empty; pinned vertices are on every level of a surface. data: of the cells
    /// of m; coarser levels have the means. kept: other vertices that are on every level, or empty. owners: of cells
    /// that overlap (mesh/cell_corners.hpp), whose coarser levels are those of triangle_cover(), or of the cells'
    /// boundary in space. Throws mesh_error, parameter_error.
    explicit mesh_levels(const mesh<Element>& m, const std::vector<bool>& pinned = {},
                         const hierarchy_params& params = {}, const cell_data& data = {},
                         const std::vector<bool>& kept = {}, std::span<const idx> owners = {});

    std::size_t size() const noexcept { return hierarchy_.levels.size(); }
    const taut::impl::hierarchy<Element>& hierarchy() const noexcept { return hierarchy_; }
    std::span<const vec3> points() const { return finest_.points(); }
    std::size_t vertices(std::size_t l) const { return hierarchy_.levels[l].vertices.size(); }

    /// Permutation between the user's numbering and that of the finest level.
    const mesh_order& order() const noexcept { return numbering_.order; }

    /// Numbers on a level of all of the user's vertices; -1 for missing ones.
    std::vector<idx> places(std::size_t l) const;

    /// The user's numbers of the vertices of a level.
    std::vector<idx> users(std::size_t l) const;

    /// A level as a mesh of its own.
    mesh<Element> level(std::size_t l) const { return l == 0 ? finest_ : level_mesh(hierarchy_, l, finest_.points()); }
    const std::vector<typename mesh<Element>::cell>& cells(std::size_t l) const { return hierarchy_.levels[l].cells; }

    /// Layout in the numbering of the level, also for the finest one.
    std::shared_ptr<const layout<Element>> make_layout(std::size_t l) const;

    /// The finest level with other ideal elements, in the user's order.
    std::shared_ptr<const layout<Element>> make_layout(const ideal_elements<Element>& wanted) const;

    bool pinned() const { return free_[0] < static_cast<idx>(vertices(0)); }
    /// One flag per vertex.
    std::span<const char> fixed(std::size_t l) const { return fixed_[l]; }

    /// Transfers from each level coarser than l to the next finer one. Refers to this object.
    std::vector<transfer_weights> transfers(std::size_t l) const;

private:
    solution_order numbering_;
    mesh<Element> finest_;
    cell_data data_;
    averaged_cell_data coarse_data_;
    taut::impl::hierarchy<Element> hierarchy_;
    std::vector<idx> free_;
    std::vector<std::vector<char>> fixed_;
};

template <class Element>
mesh_levels<Element>::mesh_levels(const mesh<Element>& m, const std::vector<bool>& pinned,
                                  const hierarchy_params& params, const cell_data& data, const std::vector<bool>& kept,
                                  std::span<const idx> owners)
    : numbering_(m, pinned), finest_(permute(m, numbering_.order))
{
    data.validate(m.cells().size());
    data_ = data.reordered(numbering_.order.cells);
    coarse_data_ = averaged_cell_data(data_, finest_.cells(), finest_.points().size());
    std::vector<char> keep;
    if (!pinned.empty())
    {
        keep.assign(finest_.points().size(), 0);
        std::fill(keep.begin() + numbering_.free_count, keep.end(), char(1));
    }
    if (!kept.empty())
    {
        keep.resize(finest_.points().size(), 0);
        for (std::size_t v = 0; v < kept.size(); ++v)
            if (kept[v]) keep[static_cast<std::size_t>(numbering_.order.vertices.old_to_new[v])] = 1;
    }
    if (Element::dimension == 2 && !owners.empty())
    {
        const auto whole = numbering_.order.cells.apply(triangle_cover(owners));
        std::vector<typename mesh<Element>::cell> cells;
        for (std::size_t c = 0; c < whole.size(); ++c)
            if (whole[c]) cells.push_back(finest_.cells()[c]);
        hierarchy_ = make_hierarchy(mesh<Element>(finest_.points(), std::move(cells)), keep, params);
        hierarchy_.levels[0].cells = finest_.cells();
    }
    else if constexpr (Element::dimension == 3 && Element::oriented)
    {
        auto boundary = owners.empty() ? decltype(boundary_facets(m, owners))() : boundary_facets(m, owners);
        for (auto& face : boundary)
            for (idx& v : face) v = numbering_.order.vertices.old_to_new[static_cast<std::size_t>(v)];
        hierarchy_ = make_hierarchy(finest_, keep, params, boundary);
    }
    else
        hierarchy_ = make_hierarchy(finest_, keep, params);
    for (const auto& level : hierarchy_.levels)
    {
        const auto end = std::lower_bound(level.vertices.begin(), level.vertices.end(), numbering_.free_count);
        free_.push_back(static_cast<idx>(end - level.vertices.begin()));
        fixed_.emplace_back(level.vertices.size(), char(0));
        std::fill(fixed_.back().begin() + free_.back(), fixed_.back().end(), char(1));
    }
}

template <class Element>
std::vector<idx> mesh_levels<Element>::places(std::size_t l) const
{
    std::vector<idx> place(order().vertices.new_to_old.size(), -1);
    const auto& chosen = hierarchy_.levels[l].vertices;
    for (std::size_t i = 0; i < chosen.size(); ++i)
        place[static_cast<std::size_t>(order().vertices.new_to_old[static_cast<std::size_t>(chosen[i])])] =
            static_cast<idx>(i);
    return place;
}

template <class Element>
std::vector<idx> mesh_levels<Element>::users(std::size_t l) const
{
    std::vector<idx> numbers;
    for (const idx v : hierarchy_.levels[l].vertices)
        numbers.push_back(order().vertices.new_to_old[static_cast<std::size_t>(v)]);
    return numbers;
}

template <class Element>
std::shared_ptr<const layout<Element>> mesh_levels<Element>::make_layout(std::size_t l) const
{
    const auto m = level(l);
    auto made = std::make_shared<layout<Element>>(m, identity_order(m), free_[l]);
    if (!data_.empty()) made->attach(l == 0 ? data_ : coarse_data_.at(m.cells(), hierarchy_.levels[l].vertices), m);
    return made;
}

template <class Element>
std::shared_ptr<const layout<Element>> mesh_levels<Element>::make_layout(const ideal_elements<Element>& wanted) const
{
    const auto& cells = numbering_.order.cells;
    auto made = std::make_shared<layout<Element>>(
        finest_, identity_order(finest_), free_[0],
        ideal_elements<Element>(cells.apply(wanted.inverse), cells.apply(wanted.measure)));
    if (!data_.empty()) made->attach(data_, finest_);
    return made;
}

template <class Element>
std::vector<transfer_weights> mesh_levels<Element>::transfers(std::size_t l) const
{
    std::vector<transfer_weights> all;
    for (; l < hierarchy_.steps.size(); ++l)
    {
        const auto& P = hierarchy_.steps[l].interpolation;
        all.push_back(transfer_weights::of_rows(P.columns, P.weights, vertices(l + 1), fixed(l + 1)));
        all.back().offsets = P.transpose.offsets;
        all.back().places = P.transpose.items;
    }
    return all;
}

// Compiled once, with the bodies.
extern template class mesh_levels<triangle>;

} // namespace taut::impl
