// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/compute/handler.hpp>
#include <taut/impl/compute/vector_space.hpp>
#include <taut/impl/core/held_marks.hpp>
#include <taut/impl/mesh/layout.hpp>
#include <taut/impl/objective/element_hessian.hpp>
#include <taut/impl/objective/real_types.hpp>

namespace taut::impl
{

/// Fixed coordinates beside those that are pinned in the layout: vectors are zero there, and so are rows and columns of
/// element Hessians, and with them the matrices of all levels. The set of fixed coordinates and their targets can
/// change without rebuilding anything else. Kernels run over fixed coordinates, and the elements at them.
template <class Element>
class held_terms
{
public:
    static constexpr int D = Element::dimension;

    held_terms(queue q, const real_types& types, const layout<Element>& mesh_layout)
        : queue_(std::move(q)),
          types_(types),
          cell_stride_(static_cast<idx>(mesh_layout.cell_stride)),
          vertex_stride_(static_cast<idx>(mesh_layout.vertex_stride))
    {
    }

    bool empty() const noexcept { return places_.empty(); }

    /// Replaces the fixed coordinates. marks: one per vertex in the user's numbering, or none.
    void hold(const layout<Element>& mesh_layout, const held_marks<D>& marks)
    {
        vertices_.clear();
        std::vector<idx> places, entries, cells;
        for (std::size_t v = 0; v < marks.size(); ++v)
        {
            if (!marks.any(v)) continue;
            const idx here = mesh_layout.order.vertices.old_to_new[v];
            for (int i = 0; i < D; ++i)
            {
                if (!marks.test(v, i)) continue;
                vertices_.push_back({v, i});
                places.push_back(here + i * vertex_stride_);
                for (const idx corner : mesh_layout.vertex_corners.row(here))
                    for (int l = 0; l < Element::corners; ++l)
                        for (int j = 0; j < D; ++j)
                            entries.push_back(corner / idx(Element::corners) +
                                              slots::at(corner % Element::corners, i, l, j) * cell_stride_);
            }
            for (const idx corner : mesh_layout.vertex_corners.row(here)) cells.push_back(corner / Element::corners);
        }
        places_ = buffer_of(places);
        entries_ = buffer_of(distinct(std::move(entries)));
        cells = distinct(std::move(cells));
        cells_ = buffer_of(cells);
        std::vector<idx> corners;
        for (std::size_t k = 0; k < Element::corners; ++k)
            for (const idx c : cells)
                corners.push_back(mesh_layout.corners[k * mesh_layout.cell_stride + static_cast<std::size_t>(c)]);
        corners_ = buffer_of(corners);
    }

    /// Sets the targets of fixed coordinates: target(v) is that of vertex v, in the user's numbering and units.
    template <class Target>
    void aim(const layout<Element>& mesh_layout, const Target& target)
    {
        if (empty()) return;
        std::vector<double> targets;
        for (const auto& [v, i] : vertices_) targets.push_back(target(v)[i] * mesh_layout.scale);
        targets_ = real_buffer(queue_, types_.position, targets);
    }

    /// Sets v = 0 at fixed coordinates.
    void mask(device_vector& v) { clear("mask", places_, v.data()); }

    /// Sets rows and columns of fixed coordinates in the Hessians of elements, packed as in hessian_slots, to 0.
    void mask_hessian(real_buffer& hessian) { clear("mask_hessian", entries_, hessian); }

    /// d = a fraction of the remaining displacement at fixed coordinates; other places stay as they are.
    void gap(const device_vector& x, double share, device_vector& d)
    {
        over_places("gap",
                    [&](handler& h)
                    {
                        const auto to = targets_.read(h), from = x.data().read(h);
                        const auto out = d.data().read_write(h);
                        const auto part = h.uniform(types_.position, share);
                        return [=, this](const auto& i, const auto& place)
                        { out[place] = cast(types_.vector, part * (to[i] - from[place])); };
                    });
    }

    /// Sets x to the targets at fixed coordinates.
    void put(device_vector& x)
    {
        over_places("put",
                    [&](handler& h)
                    {
                        const auto to = targets_.read(h);
                        const auto out = x.data().read_write(h);
                        return [=](const auto& i, const auto& place) { out[place] = to[i]; };
                    });
    }

    /// Adds to the gradients of corners the products of the Hessians of elements, not masked yet, with d, which is zero
    /// at all free coordinates.
    void add_product(const real_buffer& hessian, const device_vector& d, real_buffer& corner_gradients)
    {
        if (cells_.empty()) return;
        queue_.submit(
            [&](handler& h)
            {
                const auto cells = cells_.read(h), corners = corners_.read(h);
                const auto n = h.uniform(static_cast<idx>(cells_.size()));
                const auto cell_stride = h.uniform(cell_stride_), vertex_stride = h.uniform(vertex_stride_);
                const auto H = hessian.read(h);
                const auto along = d.data().read(h);
                const auto g = corner_gradients.read_write(h);
                h.parallel_for("held_product", cells_.size(),
                               [&](auto c)
                               {
                                   const auto cell = cells[c];
                                   for (int l = 0; l < Element::corners; ++l)
                                       for (int j = 0; j < D; ++j)
                                       {
                                           sym<double> sum = 0.0;
                                           for (int k = 0; k < Element::corners; ++k)
                                               for (int i = 0; i < D; ++i)
                                                   sum = sum + H[cell + slots::at(k, i, l, j) * cell_stride] *
                                                                   along[corners[c + k * n] + i * vertex_stride];
                                           const auto place = cell + (l * D + j) * cell_stride;
                                           g[place] = g[place] + cast(types_.position, sum);
                                       }
                               });
            });
    }

private:
    using slots = hessian_slots<D>;

    static std::vector<idx> distinct(std::vector<idx> numbers)
    {
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        return numbers;
    }

    buffer<idx> buffer_of(const std::vector<idx>& numbers)
    {
        return numbers.empty() ? buffer<idx>() : buffer<idx>(queue_, numbers);
    }

    void clear(const char* name, const buffer<idx>& where, real_buffer& what)
    {
        if (where.empty()) return;
        queue_.submit(
            [&](handler& h)
            {
                const auto places = where.read(h);
                const auto out = what.read_write(h);
                h.parallel_for(name, where.size(), [&](auto i) { out[places[i]] = 0.0; });
            });
    }

    template <class Prepare>
    void over_places(const char* name, const Prepare& prepare)
    {
        if (empty()) return;
        queue_.submit(
            [&](handler& h)
            {
                const auto places = places_.read(h);
                const auto work = prepare(h);
                h.parallel_for(name, places_.size(), [&](auto i) { work(i, places[i]); });
            });
    }

    queue queue_;
    real_types types_;
    idx cell_stride_, vertex_stride_;
    std::vector<std::pair<std::size_t, int>> vertices_; ///< vertex and coordinate of each place, the user's numbers
    buffer<idx> places_;                                ///< fixed coordinates in vectors
    buffer<idx> entries_;                               ///< entries of element Hessians
    buffer<idx> cells_, corners_;                       ///< elements at fixed vertices, and their vertices
    real_buffer targets_;                               ///< by place
};

} // namespace taut::impl
