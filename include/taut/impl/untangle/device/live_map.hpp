// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/single.hpp>
#include <taut/impl/measure/planar_size.hpp>
#include <taut/impl/objective/mesh_levels.hpp>
#include <taut/impl/objective/newton_objective.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/minimize.hpp>
#include <taut/impl/solve/prescribed.hpp>

namespace taut::impl
{

/// Map of a mesh on a device, with the data to minimise its energy: order, tables of all levels, kernels, matrices. No
/// vertex is pinned in the layout: fixed coordinates are a mask, which can change. Vertices are in the user's order;
/// lengths are those of the mesh.
template <class Element>
class live_map
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    /// x: injective. params: of a map or a shape, validated. wanted: the ideal elements, if they are not those of m.
    template <class Params>
    live_map(queue q, const mesh<Element>& m, const Params& params, precision how, const map& x,
             const ideal_elements<Element>* wanted = nullptr)
        : live_map(q, mesh_levels<Element>(m, {}, {}, params.data, {}, owners_of(params)), wanted, params,
                   types_of(how))
    {
        load(x);
    }

    /// Replaces the map by an injective one.
    void load(const map& x)
    {
        centre_ = bounding_box<D>(x).centre;
        auto local = numbers_.apply(x);
        for (vec<D>& p : local) p -= centre_;
        objective_.upload(local, x_);
    }

    /// Replaces the constraints, in the user's numbering; marks: which coordinates are fixed, one per vertex, or none.
    void constrain(const fixed_marks<D>& marks, const std::vector<directed_spring<D>>& springs,
                   const std::vector<slide<D>>& slides)
    {
        auto c = point_constraints<D>{marks, springs, slides}.renumbered(numbers_);
        for (auto& s : c.springs) s.target -= centre_;
        objective_.constrain(c);
    }

    /// targets: a map of which the fixed coordinates are read.
    void aim(const map& targets)
    {
        auto local = numbers_.apply(targets);
        for (vec<D>& p : local) p -= centre_;
        objective_.aim(local);
    }

    /// Brings fixed coordinates, at most `gap` away, to the targets of aim().
    solve::impl::prescribed_report follow(double gap,
                                          const std::function<bool(const solve::impl::prescribed_report&)>& proceed)
    {
        // Shapes in space are stretched on purpose, and a jam shows by crawling.
        if (!steps_) steps_.emplace(objective_, solve::impl::prescribed_params{.most_cost = D == 2 ? 10.0 : 1e4});
        return steps_->run(x_, gap, proceed);
    }

    /// Minimises with fixed coordinates where they are.
    solve::report minimize(const solve::params& how, const observer& ask)
    {
        auto r = solve::minimize(objective_, x_, how, ask);
        for (int& c : r.capping) c = cells_[static_cast<std::size_t>(c)];
        return r;
    }

    /// Returns whether energies and directions are in single precision.
    bool in_float() const { return objective_.rounding() > 1e-12; }

    map coordinates() const
    {
        auto x = numbers_.undo(objective_.download(x_));
        for (vec<D>& p : x) p += centre_;
        return x;
    }

    /// Rounds a map as coordinates() would return it from the device.
    map as_held(map x) const
    {
        for (vec<D>& p : x)
            for (int k = 0; k < D; ++k)
            {
                const double local = p[k] - centre_[k], scale = objective_.layout().scale;
                p[k] = (single_ ? in_single(local * scale) / scale : local) + centre_[k];
            }
        return x;
    }

private:
    template <class Params>
    live_map(queue q, const mesh_levels<Element>& levels, const ideal_elements<Element>* wanted, const Params& params,
             const real_types& types)
        : numbers_(levels.order().vertices),
          cells_(levels.order().cells.new_to_old),
          objective_(q, plan(levels, wanted, lane_form::for_device(q.device())), params.energy, params.weights,
                     std::make_shared<const newton_kernels<Element>>(q, params.energy, types)),
          x_(objective_.make_point()),
          single_(types.position == scalar_type::f32)
    {
    }

    static std::span<const idx> owners_of(const auto& params)
    {
        if constexpr (requires { params.owners; })
            return params.owners;
        else
            return {}; // of a map: its triangles do not overlap
    }

    static newton_plan<Element> plan(const mesh_levels<Element>& levels, const ideal_elements<Element>* wanted,
                                     lane_form form)
    {
        if (!wanted) return {levels, 0, form};
        return {levels.make_layout(*wanted), levels.cells(0), levels.transfers(0), levels.fixed(0), form};
    }

    permutation numbers_;
    std::vector<idx> cells_; ///< the user's numbers
    vec<D> centre_{0.0};
    newton_objective<Element> objective_;
    typename newton_objective<Element>::point x_;
    bool single_; ///< the precision of positions
    std::optional<solve::impl::prescribed_newton<newton_objective<Element>>> steps_;
};

} // namespace taut::impl
