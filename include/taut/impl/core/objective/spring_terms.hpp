// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/record.hpp>
#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/constrain/point_constraints.hpp>
#include <taut/impl/core/mesh/layout.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/real_types.hpp>

namespace taut::impl
{

/// Springs at vertices of a mesh on a device, added to the results of the element kernels. A spring belongs to one of
/// the elements at its vertex, so that sums, gathers and assemblies of elements include it.
template <class Element>
class spring_terms
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::size_t corners = Element::corners;

    /// springs: in the user's numbers and units.
    spring_terms(queue q, const real_types& types, const layout<Element>& mesh_layout,
                 std::span<const directed_spring<D>> springs);

    /// Replaces the springs, in the user's numbering and units. mesh_layout: the same as before.
    void set_springs(const layout<Element>& mesh_layout, std::span<const directed_spring<D>> springs);

    /// Adds to the energies of elements at x.
    void add_energy(const device_vector& x, real_buffer& energies)
    {
        launch_energies(x, stiffness_, stiffness_, std::array{0.0}, energies);
    }

    /// Adds to the energies of elements at x + unit[0] a d, `steps.size()` segments of cell_stride each.
    template <std::size_t N>
    void add_energies(const device_vector& x, const device_vector& d, const real_buffer& unit,
                      const std::array<double, N>& steps, real_buffer& energies)
    {
        launch_energies(x, d.data(), unit, steps, energies);
    }

    /// Adds to the gradients of corners.
    void add_gradient(const device_vector& x, real_buffer& corner_gradients)
    {
        if (count_ > 0) kernels_->gradient(count_, with({{"x", x.data()}, {"corner_gradient", corner_gradients}}));
    }

    /// Adds to the Hessians of elements, packed as in hessian_slots.
    void add_hessian(real_buffer& hessian)
    {
        if (count_ > 0) kernels_->hessian(count_, with({{"hessian", hessian}}));
    }

private:
    using real = sym<double>;
    static constexpr int trials = 4;

    /// Springs as arguments of a kernel.
    struct list
    {
        recording::in_array<idx> cell, vertex;
        recording::in_array<double> stiffness, target;
        sym<idx> count, cells, vertices;

        list(recording& r, const real_types& types)
            : cell(r.in<idx>("cell")),
              vertex(r.in<idx>("vertex")),
              stiffness(r.in<double>("stiffness", types.vector)),
              target(r.in<double>("target", types.position)),
              count(r.scalar<idx>("count")),
              cells(r.scalar<idx>("cell_stride")),
              vertices(r.scalar<idx>("vertex_stride"))
        {
        }
        auto place(sym<idx> i, idx j, idx k) const { return vertex[i + j * count] + k * vertices; }
        auto stiff(sym<idx> i, idx j, idx k) const { return stiffness[i + (j * D + k) * count]; }
        auto at_target(sym<idx> i, idx j, idx k) const { return target[i + (j * D + k) * count]; }
    };

    /// Range of one work-item per element with springs, or per such element and step length.
    struct kernels
    {
        recorded_kernel energies, gradient, hessian;

        kernels(const queue& q, const real_types& types) : kernels(program(q, types)) {}
        explicit kernels(const traced_program& p)
            : energies(p, "spring_energies"), gradient(p, "spring_gradient"), hessian(p, "spring_hessian")
        {
        }

        static traced_program program(const queue& q, const real_types& types)
        {
            const auto form = impl::form_for(q.device());
            return {q, {record_energies(types, form), record_gradient(types, form), record_hessian(types, form)}};
        }

        static kernel_text record_energies(const real_types& types, kernel_form form)
        {
            recording r(types.vector);
            const list l(r, types);
            const auto p = r.in<double>("x", types.position);
            const auto d = r.in<double>("d", types.vector);
            const auto unit = r.in<double>("unit", types.vector);
            auto energies = r.inout<double>("energy", types.vector);
            const auto item = r.global_id(), i = item % l.count, trial = item / l.count;
            real a = r.scalar<double>("step0", types.vector);
            for (int t = 1; t < trials; ++t)
                a = select(trial == t, r.scalar<double>("step" + std::to_string(t), types.vector), a);
            const auto at = l.cell[i] + trial * l.cells;
            real sum = energies[at];
            for (idx j = 0; j < idx(corners); ++j)
                for (idx k = 0; k < D; ++k)
                {
                    const auto v = l.place(i, j, k);
                    const auto along = d[select(a == 0.0, sym<idx>(0), v)]; // d may be short where no step is taken
                    const auto gap = cast(types.vector, p[v] - l.at_target(i, j, k)) + unit[sym<idx>(0)] * a * along;
                    sum = sum + l.stiff(i, j, k) * gap * gap;
                }
            energies[at] = sum;
            return r.finish("spring_energies", form, kernel_use::seldom);
        }

        static kernel_text record_gradient(const real_types& types, kernel_form form)
        {
            recording r(types.vector);
            const list l(r, types);
            const auto p = r.in<double>("x", types.position);
            auto g = r.inout<double>("corner_gradient", types.position);
            const auto i = r.global_id();
            for (idx j = 0; j < idx(corners); ++j)
                for (idx k = 0; k < D; ++k)
                {
                    const auto slot = l.cell[i] + (j * D + k) * l.cells;
                    const auto gap = p[l.place(i, j, k)] - l.at_target(i, j, k);
                    g[slot] = g[slot] + 2.0 * cast(types.position, l.stiff(i, j, k)) * gap;
                }
            return r.finish("spring_gradient", form, kernel_use::seldom);
        }

        static kernel_text record_hessian(const real_types& types, kernel_form form)
        {
            recording r(types.vector);
            const list l(r, types);
            auto H = r.inout<double>("hessian", types.vector);
            const auto i = r.global_id();
            for (idx j = 0; j < idx(corners); ++j)
                for (idx k = 0; k < D; ++k)
                {
                    const auto at = l.cell[i] + static_cast<idx>(hessian_slots<D>::at(j, k, j, k)) * l.cells;
                    H[at] = H[at] + 2.0 * l.stiff(i, j, k);
                }
            return r.finish("spring_hessian", form, kernel_use::seldom);
        }
    };

    std::vector<named_argument> with(std::initializer_list<named_argument> more) const;

    template <std::size_t N>
    void launch_energies(const device_vector& x, const real_buffer& d, const real_buffer& unit,
                         const std::array<double, N>& steps, real_buffer& energies);

    queue queue_;
    real_types types_;
    idx cell_stride_, vertex_stride_;
    std::shared_ptr<const kernels> kernels_; ///< none before there are springs
    std::size_t count_ = 0;                  ///< elements that carry springs
    buffer<idx> cell_, vertex_;
    real_buffer stiffness_, target_;
};

template <class Element>
spring_terms<Element>::spring_terms(queue q, const real_types& types, const layout<Element>& mesh_layout,
                                    std::span<const directed_spring<D>> springs)
    : queue_(std::move(q)),
      types_(types),
      cell_stride_(static_cast<idx>(mesh_layout.cell_stride)),
      vertex_stride_(static_cast<idx>(mesh_layout.vertex_stride))
{
    set_springs(mesh_layout, springs);
}

template <class Element>
void spring_terms<Element>::set_springs(const layout<Element>& mesh_layout, std::span<const directed_spring<D>> springs)
{
    struct entry
    {
        std::array<const directed_spring<D>*, corners> at{};
    };
    std::map<idx, entry> by_cell;
    for (const auto& s : springs)
    {
        const auto around =
            mesh_layout.vertex_corners.row(mesh_layout.order.vertices.old_to_new[static_cast<std::size_t>(s.vertex)]);
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
    if (!kernels_) kernels_ = std::make_shared<const kernels>(queue_, types_);
    cell_ = buffer<idx>(queue_, cell);
    vertex_ = buffer<idx>(queue_, vertex);
    stiffness_ = real_buffer(queue_, types_.vector, stiffness);
    target_ = real_buffer(queue_, types_.position, target);
}

template <class Element>
std::vector<named_argument> spring_terms<Element>::with(std::initializer_list<named_argument> more) const
{
    std::vector<named_argument> all = {{"cell", cell_},
                                       {"vertex", vertex_},
                                       {"stiffness", stiffness_},
                                       {"target", target_},
                                       {"count", static_cast<idx>(count_)},
                                       {"cell_stride", cell_stride_},
                                       {"vertex_stride", vertex_stride_}};
    all.insert(all.end(), more);
    return all;
}

template <class Element>
template <std::size_t N>
void spring_terms<Element>::launch_energies(const device_vector& x, const real_buffer& d, const real_buffer& unit,
                                            const std::array<double, N>& steps, real_buffer& energies)
{
    static_assert(N <= trials);
    if (count_ == 0) return;
    const auto step = [&](std::size_t k) { return steps[std::min(k, N - 1)]; };
    kernels_->energies(N * count_, with({{"x", x.data()},
                                         {"d", d},
                                         {"unit", unit},
                                         {"energy", energies},
                                         {"step0", step(0)},
                                         {"step1", step(1)},
                                         {"step2", step(2)},
                                         {"step3", step(3)}}));
}

// Compiled once, with the bodies.
extern template class spring_terms<triangle>;

} // namespace taut::impl
