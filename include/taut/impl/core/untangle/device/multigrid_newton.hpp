// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/energy/regularized.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/solve/pcg.hpp>
#include <taut/impl/core/untangle/regularized_newton.hpp>

namespace taut::impl
{

/// Regularised energy as an energy of kernels.
inline any_energy regularized_energy(double eps, double area_weight)
{
    return any_energy(energy::impl::regularized_element{}).with_parameters({eps, area_weight});
}

/// Plan of a problem: the mesh with the target shapes in place of its own, which may be flat, and the coarser levels of
/// the mesh.
template <class Element>
newton_plan<Element> regularized_plan(const regularized_problem<Element>& problem, lane_form form)
{
    const auto layout_of = [&](const mesh<Element>& local, const mesh_order& order, idx free)
    {
        ideal_elements<Element> wanted({}, {});
        for (const auto& s : order.cells.apply(problem.shapes))
        {
            double measure = Element::measure_factor;
            for (int k = 0; k < Element::dimension; ++k) measure /= s.inverse[k][k];
            wanted.inverse.push_back(s.inverse);
            wanted.measure.push_back(measure);
        }
        return std::make_shared<const layout<Element>>(local, order, free, wanted);
    };
    const auto pinned = problem.held.pinned();
    try
    {
        const mesh_levels<Element> levels(problem.rest, pinned, {}, {}, {}, problem.owners);
        const auto fixed = levels.fixed(0);
        const auto free = static_cast<idx>(std::count(fixed.begin(), fixed.end(), char(0)));
        return {layout_of(levels.level(0), levels.order(), free), levels.cells(0), levels.transfers(0), fixed, form};
    }
    catch (const mesh_error&) // no surface that can be thinned: one level will do
    {
    }
    const solution_order numbers(problem.rest, pinned);
    const auto local = permute(problem.rest, numbers.order);
    std::vector<char> fixed(local.points().size(), 0);
    std::fill(fixed.begin() + numbers.free_count, fixed.end(), char(1));
    return {layout_of(local, numbers.order, numbers.free_count), local.cells(), {}, fixed, form};
}

/// Newton's method on a device, without a factorisation: preconditioned conjugate gradients with a multigrid V-cycle,
/// in time that grows with the mesh.
template <class Element>
class multigrid_newton final : public regularized_newton<Element>
{
    using base = regularized_newton<Element>;

public:
    static constexpr int D = Element::dimension;
    using typename base::map;
    using kernels = newton_kernels<Element>;

    /// Kernels of all problems, in double: inverted elements are stiffer than the rest by more than float resolves.
    static std::shared_ptr<const kernels> trace(const queue& q)
    {
        return std::make_shared<const kernels>(q, regularized_energy(1, 1), types_of(precision::fp64),
                                               capping_elements::left);
    }

    /// traced: by trace().
    multigrid_newton(queue q, std::shared_ptr<const kernels> traced, regularized_problem<Element> problem)
        : multigrid_newton(q, std::move(traced), regularized_plan(problem, lane_form::for_device(q.device())),
                           std::move(problem))
    {
    }

    double value(const map& x) override
    {
        bind();
        objective_.upload(x, x_);
        return objective_.value(x_);
    }

    double step(map& x, double here) override
    {
        bind();
        this->length_ = 0;
        objective_.upload(x, x_);
        objective_.gradient(x_, g_);
        objective_.linearize(x_, false);
        const auto model = pcg_.solve(
            g_, [this](const auto& v, auto& out) { objective_.hessian_product(v, out); },
            [this](const auto& v, auto& out) { objective_.precondition(v, out); }, d_,
            [this] { return !this->proceed || this->proceed(); });
        if (!(model.slope < 0) || (this->proceed && !this->proceed())) return here;

        double longest = 1;
        for (int round = 0; round < 10; ++round, longest /= 16)
        {
            std::array<double, 4> a, values;
            for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::ldexp(longest, -static_cast<int>(i));
            const double unit = trial_values(a, values);
            for (std::size_t i = 0; i < a.size(); ++i)
            {
                const double t = unit * a[i];
                if (!(values[i] <= here + 1e-4 * t * model.slope)) continue;
                objective_.step(x_, t, d_, x_);
                x = objective_.download(x_);
                this->length_ = t;
                return values[i];
            }
        }
        return here;
    }

    const newton_objective<Element>& objective() const { return objective_; } ///< for measurements

private:
    multigrid_newton(queue& q, std::shared_ptr<const kernels> traced, newton_plan<Element> plan,
                     regularized_problem<Element>&& problem)
        : base(std::move(problem)),
          objective_(q, std::move(plan), regularized_energy(1, this->area_weight_), energy::weighting::measure,
                     std::move(traced), {.held = problem.held.without_pinned(), .springs = {}}),
          space_(objective_.space()),
          pcg_(space_, {.max_steps = 100, .gain = 0.1}), // loose ones end in ever shorter steps
          x_(objective_.make_point()),
          g_(objective_.space().make()),
          d_(objective_.space().make())
    {
    }

    void bind()
    {
        objective_.set_parameters(std::array{this->eps, this->area_weight_});
        objective_.set_springs(this->springs);
    }

    /// Values at unit * a along d_; the unit keeps the elements of a barrier positive.
    double trial_values(std::span<const double> a, std::span<double> values)
    {
        if (this->eps == 0) return objective_.capped_values(x_, d_, 0.9, a, values);
        objective_.values(x_, d_, a, values);
        return 1;
    }

    newton_objective<Element> objective_;
    const device_vectors space_;
    solve::impl::pcg<const device_vectors> pcg_;
    typename newton_objective<Element>::point x_;
    typename newton_objective<Element>::vector g_, d_;
};

} // namespace taut::impl
