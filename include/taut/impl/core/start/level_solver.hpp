// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/minimizers.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>

namespace taut::impl
{

/// Some map without flips, for warm-up launches.
inline std::vector<vec2> some_map(const mesh<triangle>& m)
{
    return barycentric_map(m, facets(m), {}).uv;
}
inline std::vector<vec3> some_map(const mesh<tetrahedron>& m)
{
    return m.points();
}

/// Minimises an energy on one level of a hierarchy after another. The kernels are traced and compiled once; buffers and
/// matrices live as long as the level that they serve is at work.
template <class Element>
class level_solver
{
public:
    static constexpr int D = Element::dimension;
    using kernels = newton_kernels<Element>;
    using plan = newton_plan<Element>;

    /// Refers to the levels.
    level_solver(const queue& q, const mesh_levels<Element>& levels, const any_energy& energy,
                 energy::weighting weights, const real_types& types)
        : queue_(q),
          levels_(levels),
          energy_(energy),
          weights_(weights),
          kernels_(std::make_shared<const kernels>(q, energy, types))
    {
    }

    /// Launches every kernel once, on the coarsest level, so that drivers compile them. springs: those of springs, too.
    void warm_up(bool springs = false)
    {
        const std::size_t coarsest = levels_.size() - 1;
        plan host(levels_, coarsest, lane_form::for_device(queue_.device()));
        point_constraints<D> slack;
        if (springs) slack.springs.push_back({0, vec<D>(0), vec<D>(0)});
        level(*this, std::move(host), impl::some_map(levels_.level(coarsest)), slack).warm_up();
    }

    double energy_at_rest() const { return energy::rest_value<D>(energy_); }

    /// Solver state of one level.
    class level
    {
    public:
        /// host: that of the level. x: the map to start from, coordinates of the level's vertices. constraints: in the
        /// level's numbers.
        level(level_solver& owner, plan host, const std::vector<vec<D>>& x,
              const point_constraints<D>& constraints = {})
            : objective_(owner.queue_, std::move(host), owner.energy_, owner.weights_, owner.kernels_, constraints),
              x_(objective_.make_point())
        {
            objective_.upload(x, x_);
        }

        std::vector<vec<D>> download() const { return objective_.download(x_); }

        /// Changes the targets or stiffnesses of the same springs.
        void set_springs(std::span<const directed_spring<D>> springs) { objective_.set_springs(springs); }

        /// Relaxes the elements that cap the first step, for maps that come from a coarser level.
        void relax() { objective_.relax(x_); }

        solve::report minimize(const solve::params& how, const run_limits& limits = {})
        {
            return solve::minimize(objective_, x_, how, limits);
        }

        void warm_up() { objective_.warm_up(x_); }

    private:
        newton_objective<Element> objective_;
        typename newton_objective<Element>::point x_;
    };

private:
    queue queue_;
    const mesh_levels<Element>& levels_;
    any_energy energy_;
    energy::weighting weights_;
    std::shared_ptr<const kernels> kernels_;
};

} // namespace taut::impl
