// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/compute/handler.hpp>
#include <taut/compute/vector_space.hpp>
#include <taut/constrain/point_constraints.hpp>
#include <taut/mesh/layout.hpp>
#include <taut/objective/real_types.hpp>

namespace taut
{

/// Point constraints of a mesh on a device, as an addition to what the kernels of elements give. A spring is counted
/// with one of the elements at its vertex, so that sums, gathers and assemblies of elements carry it along. Coordinates
/// that are held alone are a mask: the search directions of a solver are zero there.
template <class Element>
class constraint_terms
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::size_t corners = Element::corners;

    /// c: in the user's numbers and units.
    constraint_terms(queue q, const real_types& types, const layout<Element>& mesh_layout,
                     const point_constraints<D>& c)
        : queue_(std::move(q)),
          types_(types),
          cell_stride_(static_cast<idx>(mesh_layout.cell_stride)),
          vertex_stride_(static_cast<idx>(mesh_layout.vertex_stride))
    {
        if (!c.held.empty()) make_mask(held_marks<D>(mesh_layout.order.vertices.apply(c.held.bits())));
        if (!c.springs.empty()) set_springs(mesh_layout, c.springs);
    }

    /// Other springs, in the user's numbers and units. mesh_layout: the same as before.
    void set_springs(const layout<Element>& mesh_layout, std::span<const directed_spring<D>> springs)
    {
        struct entry
        {
            std::array<const directed_spring<D>*, corners> at{};
        };
        std::map<idx, entry> by_cell;
        for (const auto& s : springs)
        {
            const auto around = mesh_layout.vertex_corners.row(
                mesh_layout.order.vertices.old_to_new[static_cast<std::size_t>(s.vertex)]);
            if (around.empty()) continue; // no element sees the vertex, and none can be distorted for it
            const auto corner = static_cast<std::size_t>(around.front());
            by_cell[static_cast<idx>(corner / corners)].at[corner % corners] = &s;
        }
        count_ = by_cell.size();
        if (count_ == 0) return;
        const double unit = mesh_layout.scale;
        std::vector<idx> cell, vertex(corners * count_);
        std::vector<double> stiffness(corners * D * count_, 0), target(corners * D * count_, 0);
        for (const auto& [c, e] : by_cell)
        {
            const std::size_t i = cell.size();
            cell.push_back(c);
            for (std::size_t j = 0; j < corners; ++j)
            {
                vertex[i + j * count_] = mesh_layout.corners[j * mesh_layout.cell_stride + static_cast<std::size_t>(c)];
                if (!e.at[j]) continue;
                for (std::size_t k = 0; k < D; ++k)
                {
                    const std::size_t place = i + (j * D + k) * count_;
                    stiffness[place] = e.at[j]->stiffness[static_cast<int>(k)] / (unit * unit);
                    target[place] = e.at[j]->target[static_cast<int>(k)] * unit;
                }
            }
        }
        cell_ = buffer<idx>(queue_, cell);
        vertex_ = buffer<idx>(queue_, vertex);
        stiffness_ = real_buffer(queue_, types_.vector, stiffness);
        target_ = real_buffer(queue_, types_.position, target);
    }

    /// To the energies of elements at x.
    void add_energy(const device_vector& x, real_buffer& energies)
    {
        if (count_ == 0) return;
        queue_.submit(
            [&](handler& h)
            {
                const list l(*this, h);
                const auto p = x.data().read(h);
                const auto e = energies.read_write(h);
                h.parallel_for("spring_energy", count(),
                               [&](auto i)
                               {
                                   auto sum = e[l.cell[i]];
                                   for (idx j = 0; j < idx(corners); ++j)
                                       for (idx k = 0; k < D; ++k)
                                       {
                                           const auto gap =
                                               cast(types_.vector, p[l.place(i, j, k)] - l.at_target(i, j, k));
                                           sum = sum + l.stiff(i, j, k) * gap * gap;
                                       }
                                   e[l.cell[i]] = sum;
                               });
            });
    }

    /// To the energies of elements at x + unit[0] a d, `steps.size()` segments of cell_stride each.
    template <std::size_t N>
    void add_energies(const device_vector& x, const device_vector& d, const real_buffer& unit,
                      const std::array<double, N>& steps, real_buffer& energies)
    {
        if (count_ == 0) return;
        queue_.submit(
            [&](handler& h)
            {
                const list l(*this, h);
                const auto p = x.data().read(h);
                const auto along = d.data().read(h);
                const auto u = unit.read(h);
                std::array<sym<double>, N> a;
                for (std::size_t n = 0; n < N; ++n) a[n] = h.uniform(types_.vector, steps[n]);
                const auto e = energies.read_write(h);
                h.parallel_for("spring_along", count(),
                               [&](auto i)
                               {
                                   for (std::size_t n = 0; n < N; ++n)
                                   {
                                       const auto at = l.cell[i] + static_cast<idx>(n) * l.cells;
                                       auto sum = e[at];
                                       for (idx j = 0; j < idx(corners); ++j)
                                           for (idx k = 0; k < D; ++k)
                                           {
                                               const auto v = l.place(i, j, k);
                                               const auto gap = cast(types_.vector, p[v] - l.at_target(i, j, k)) +
                                                                u[0] * a[n] * along[v];
                                               sum = sum + l.stiff(i, j, k) * gap * gap;
                                           }
                                       e[at] = sum;
                                   }
                               });
            });
    }

    /// To the gradients of corners.
    void add_gradient(const device_vector& x, real_buffer& corner_gradients)
    {
        if (count_ == 0) return;
        queue_.submit(
            [&](handler& h)
            {
                const list l(*this, h);
                const auto p = x.data().read(h);
                const auto g = corner_gradients.read_write(h);
                h.parallel_for("spring_gradient", count(),
                               [&](auto i)
                               {
                                   for (idx j = 0; j < idx(corners); ++j)
                                       for (idx k = 0; k < D; ++k)
                                       {
                                           const auto slot = l.cell[i] + (j * D + k) * l.cells;
                                           const auto gap = p[l.place(i, j, k)] - l.at_target(i, j, k);
                                           g[slot] = g[slot] + 2.0 * cast(types_.position, l.stiff(i, j, k)) * gap;
                                       }
                               });
            });
    }

    /// To the Hessians of elements, packed as hessian_slots say: slot(j, k) is that of coordinate k of corner j.
    template <class Slot>
    void add_hessian(real_buffer& hessian, const Slot& slot)
    {
        if (count_ == 0) return;
        queue_.submit(
            [&](handler& h)
            {
                const list l(*this, h);
                const auto H = hessian.read_write(h);
                h.parallel_for("spring_hessian", count(),
                               [&](auto i)
                               {
                                   for (idx j = 0; j < idx(corners); ++j)
                                       for (idx k = 0; k < D; ++k)
                                       {
                                           const auto at = l.cell[i] + static_cast<idx>(slot(j, k)) * l.cells;
                                           H[at] = H[at] + 2.0 * l.stiff(i, j, k);
                                       }
                               });
            });
    }

    /// v = 0 where a coordinate is held alone.
    void mask(device_vector& v)
    {
        if (mask_.empty()) return;
        queue_.submit(
            [&](handler& h)
            {
                const auto free = mask_.read(h);
                const auto g = v.data().read_write(h);
                h.parallel_for("mask", mask_.size(), [&](auto i) { g[i] = free[i] * g[i]; });
            });
    }

private:
    /// The springs as a kernel sees them.
    struct list
    {
        in_array<idx> cell, vertex;
        in_array<double> stiffness, target;
        sym<idx> n, cells, vertices;

        list(const constraint_terms& c, handler& h)
            : cell(c.cell_.read(h)),
              vertex(c.vertex_.read(h)),
              stiffness(c.stiffness_.read(h)),
              target(c.target_.read(h)),
              n(h.uniform(static_cast<idx>(c.count_))),
              cells(h.uniform(c.cell_stride_)),
              vertices(h.uniform(c.vertex_stride_))
        {
        }
        auto place(sym<idx> i, idx j, idx k) const { return vertex[i + j * n] + k * vertices; }
        auto stiff(sym<idx> i, idx j, idx k) const { return stiffness[i + (j * D + k) * n]; }
        auto at_target(sym<idx> i, idx j, idx k) const { return target[i + (j * D + k) * n]; }
    };

    range count() const { return {count_}; }

    void make_mask(const held_marks<D>& held)
    {
        const auto stride = static_cast<std::size_t>(vertex_stride_);
        std::vector<double> free(D * stride, 1);
        for (std::size_t v = 0; v < held.size(); ++v)
            for (std::size_t k = 0; k < D; ++k)
                if (held.test(v, static_cast<int>(k))) free[k * stride + v] = 0;
        mask_ = real_buffer(queue_, types_.vector, free);
    }

    queue queue_;
    real_types types_;
    idx cell_stride_, vertex_stride_;
    std::size_t count_ = 0; ///< elements that carry springs
    buffer<idx> cell_, vertex_;
    real_buffer stiffness_, mask_, target_;
};

} // namespace taut
