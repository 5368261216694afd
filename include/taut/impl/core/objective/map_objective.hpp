// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/gather.hpp>
#include <taut/impl/core/energy/characteristic_gradient.hpp>
#include <taut/impl/core/energy/characteristic_value.hpp>
#include <taut/impl/core/objective/device_solvers.hpp>
#include <taut/impl/core/objective/element_arrays.hpp>
#include <taut/impl/core/objective/element_kernels.hpp>
#include <taut/impl/core/objective/fixed_terms.hpp>
#include <taut/impl/core/objective/spring_terms.hpp>
#include <taut/impl/core/solve/objective_bodies.hpp>
#include <taut/solve_params.hpp>

namespace taut::impl
{

/// Distortion of a map of a mesh as an objective for the solvers (solve/objective.hpp), evaluated on a device:
///
///     f(x) = sum over cells of w_c E(S_c(x)) / sum of w_c + sum over springs of k_v |x_v - t_v|^2
///
/// with w_c = 1 or the rest measure. A point holds the coordinates of all vertices in layout order, D x vertex_stride;
/// vectors have the same shape and are zero at fixed coordinates, so that these never move.
/// Kernels per evaluation: elements, gather (paper Fig. 8), one reduction; one host wait.
template <class Element>
class map_objective
{
public:
    static constexpr int D = Element::dimension;
    using vector = device_vector;
    using point = device_vector;

    using kernels = element_kernels<Element>;

    /// constraints: besides the pins of the layout, in the user's numbers.
    map_objective(queue q, std::shared_ptr<const layout<Element>> mesh_layout, const any_energy& energy,
                  energy::weighting weights, const real_types& types = {}, const point_constraints<D>& constraints = {})
        : map_objective(q, std::move(mesh_layout), energy, weights, types,
                        std::make_shared<const kernels>(q, energy, types), constraints)
    {
    }

    /// Shares kernels of the same energy and types with another objective.
    map_objective(queue q, std::shared_ptr<const layout<Element>> mesh_layout, const any_energy& energy,
                  energy::weighting weights, const real_types& types, std::shared_ptr<const kernels> traced,
                  const point_constraints<D>& constraints = {});

    const device_vectors& space() const { return space_; }
    const taut::impl::layout<Element>& layout() const { return *layout_; }
    point make_point() const { return space_.make_points(types_.position); }
    void copy(const point& x, point& y) const { space_.copy(x, y); }
    void step(const point& x, double a, const vector& d, point& out) const { space_.step(x, a, d, out); }

    /// Transfers coordinates in the user's order and units to the device and back.
    void upload(const std::vector<vec<D>>& x, point& p) const { p.upload(layout_->to_local(x)); }
    std::vector<vec<D>> download(const point& p) const { return layout_->to_user(p.download()); }

    /// Replaces the parameters of the energy, in the same number.
    void set_parameters(std::span<const double> values)
    {
        for (std::size_t k = 0; k < values.size(); ++k) arrays_->parameters.at(k).second = values[k];
    }
    /// Replaces the springs, in the user's numbering and units.
    void set_springs(std::span<const directed_spring<D>> springs) { springs_.set_springs(*layout_, springs); }
    /// Replaces the constraints, in the user's numbering and units.
    void constrain(const point_constraints<D>& c)
    {
        springs_.set_springs(*layout_, c.springs);
        fixed_.fix(*layout_, c.held, c.slides);
    }

    /// Sets the targets of fixed coordinates other than those of pinned vertices, for linearize_towards() and put():
    /// target(v) is that of vertex v, in the user's numbers and units.
    template <class Target>
    void aim(const Target& target)
    {
        fixed_.aim(*layout_, target);
    }
    /// Sets x to the targets at fixed coordinates, to the last bit of the type of positions.
    void put(point& x) { fixed_.put(x); }

    double value(const point& x)
    {
        kernels_->value(cells(), arrays_->with(x.data(), {{"energy", energies_}}));
        springs_.add_energy(x, energies_);
        return summed();
    }

    double value_gradient(const point& x, vector& g)
    {
        gradient(x, g);
        return summed();
    }

    /// The same; square = g'g.
    double value_gradient(const point& x, vector& g, double& square);

    /// Computes the gradient g without a wait.
    void gradient(const point& x, vector& g)
    {
        element_gradients(x);
        gather_(corner_gradients_, g.data());
        fixed_.project(g);
    }

    /// Values f(x + a[i] d), four step lengths per launch, one wait in all.
    void values(const point& x, const vector& d, std::span<const double> a, std::span<double> out)
    {
        const auto results = enqueue_values(x, d, one_, a);
        if (!results.empty()) reductions_.fetch();
        fold_values(results, out);
    }

    /// Maximum step a for which no element flips on [x, x + a d); infinity if none ever does.
    double max_step(const point& x, const vector& d)
    {
        const auto least = enqueue_max_step(x, d);
        reductions_.fetch();
        return reductions_.value(least);
    }

    /// Elements that flip first along d, up to sixteen within twice the minimum step, in the user's numbering.
    std::vector<int> capping(const point& x, const vector& d);

    /// Values f(x + u a[i] d) with u = min(most, fraction * max_step), which is returned. One wait in all.
    double capped_values(const point& x, const vector& d, double fraction, std::span<const double> a,
                         std::span<double> out, double most = 1);

    /// The same with most = 1, and full = x + d with its gradient g; returns g'g second. Still one wait.
    std::pair<double, double> capped_values(const point& x, const vector& d, double fraction, std::span<const double> a,
                                            std::span<double> out, point& full, vector& g);

    /// Launches the kernels of Newton's method once, so that the driver compiles them; those of other methods are
    /// compiled at first use.
    void warm_up(const point& x);

    /// Norm of a gradient that is typical of the mesh: the same relative gradient then means the same on every mesh and
    /// scale. After Zhu, Bridson, Kaufman 2018 ("Blended cured quasi-Newton"), section 4.
    double gradient_scale(const point&) const { return gradient_scale_; }

    /// Typical value of f, which is a mean of the energy.
    double value_scale() const { return value_scale_; }

    std::uint64_t waits() const { return queue_.counters().waits; }

    /// Rounding error of a value, by its size: sums are in double, and the errors of many elements average out.
    double rounding() const { return types_.vector == scalar_type::f64 ? 1e-14 : 1e-8; }

protected:
    /// Energies and gradients of elements at x.
    void element_gradients(const point& x);

    /// Applies a displacement d of fixed coordinates to the gradients of elements, which are those at the current
    /// point, in the model of `hessian`, not masked yet: g = the gradient at the others. f here, and by how much the
    /// model changes. One wait.
    solve::impl::model_change move_held(const real_buffer& hessian, const vector& d, vector& g);

    range cells() const { return {layout_->cell_stride, taut::impl::layout<Element>::step}; }

    std::shared_ptr<const element_arrays<Element>> arrays() const { return arrays_; }

    spring_terms<Element>& springs() { return springs_; }
    fixed_terms<Element>& fixed() { return fixed_; }

private:
    /// Gathers rows of free vertices only: the others get zero.
    gather make_gather();

    using sums = std::vector<reductions::result>;

    sums enqueue_values(const point& x, const vector& d, const real_buffer& unit, std::span<const double> a);

    struct capped_sums
    {
        reductions::result least;
        sums values;
    };

    capped_sums enqueue_capped_values(const point& x, const vector& d, double fraction, std::span<const double> a,
                                      double most);

    double fold_capped_values(const capped_sums& r, double fraction, std::span<double> out, double most) const
    {
        fold_values(r.values, out);
        const double bound = fraction * reductions_.value(r.least);
        return bound >= most ? most : bound;
    }

    void fold_values(const sums& results, std::span<double> out) const
    {
        std::size_t i = 0;
        for (const auto& r : results)
            for (std::size_t k = 0; k < r.count; ++k) out[i++] = reductions_.value(r, k);
    }

    reductions::result enqueue_max_step(const point& x, const vector& d)
    {
        kernels_->first_flips(cells(), arrays_->with(x.data(), {{"d", d.data()}, {"first", energies_}}));
        return reductions_.minimum(energies_, static_cast<std::size_t>(layout_->cell_count));
    }

    reductions::result enqueue_sum()
    {
        return reductions_.sum(energies_, {.length = static_cast<std::size_t>(layout_->cell_count)});
    }

    double summed()
    {
        const auto sum = enqueue_sum();
        reductions_.fetch();
        return reductions_.value(sum);
    }

    queue queue_;
    std::shared_ptr<const taut::impl::layout<Element>> layout_;
    real_types types_;
    device_vectors space_;
    reductions reductions_;
    std::shared_ptr<const kernels> kernels_;
    std::shared_ptr<element_arrays<Element>> arrays_;
    real_buffer energies_;
    real_buffer one_, limit_; ///< units of step lengths
    real_buffer corner_gradients_;
    gather gather_;
    spring_terms<Element> springs_;
    fixed_terms<Element> fixed_;
    double gradient_scale_, value_scale_;
};

template <class Element>
map_objective<Element>::map_objective(queue q, std::shared_ptr<const impl::layout<Element>> mesh_layout,
                                      const any_energy& energy, energy::weighting weights, const real_types& types,
                                      std::shared_ptr<const kernels> traced, const point_constraints<D>& constraints)
    : queue_(std::move(q)),
      layout_(std::move(mesh_layout)),
      types_(types),
      space_(queue_, types.vector, D * layout_->vertex_stride),
      reductions_(queue_),
      kernels_(std::move(traced)),
      arrays_(std::make_shared<element_arrays<Element>>(queue_, types.vector, *layout_, weights, energy)),
      energies_(queue_, types.vector, kernels::trials * layout_->cell_stride),
      one_(queue_, types.vector, std::array{1.0}),
      limit_(queue_, types.vector, std::array{1.0}),
      corner_gradients_(queue_, types.position, (D + 1) * D * layout_->cell_stride),
      gather_(make_gather()),
      springs_(queue_, types, *layout_, constraints.springs),
      fixed_(queue_, types, *layout_),
      gradient_scale_(characteristic_gradient(*layout_, energy, weights)),
      value_scale_(characteristic_value<D>(energy))
{
    fixed_.fix(*layout_, constraints.held, constraints.slides);
}

template <class Element>
double map_objective<Element>::value_gradient(const point& x, vector& g, double& square)
{
    gradient(x, g);
    const auto sum = enqueue_sum();
    const auto norm = reductions_.dot(g.data(), g.data(), space_.size());
    reductions_.fetch();
    square = reductions_.value(norm);
    return reductions_.value(sum);
}

template <class Element>
std::vector<int> map_objective<Element>::capping(const point& x, const vector& d)
{
    constexpr std::size_t most = 16;
    const double least = max_step(x, d);
    std::vector<double> flips(static_cast<std::size_t>(layout_->cell_count));
    energies_.download(std::span(flips));
    std::vector<int> found;
    for (std::size_t c = 0; c < flips.size() && found.size() < most; ++c)
        if (flips[c] <= 2 * least) found.push_back(layout_->order.cells.new_to_old[c]);
    return found;
}

template <class Element>
double map_objective<Element>::capped_values(const point& x, const vector& d, double fraction,
                                             std::span<const double> a, std::span<double> out, double most)
{
    const auto capped = enqueue_capped_values(x, d, fraction, a, most);
    reductions_.fetch();
    return fold_capped_values(capped, fraction, out, most);
}

template <class Element>
std::pair<double, double> map_objective<Element>::capped_values(const point& x, const vector& d, double fraction,
                                                                std::span<const double> a, std::span<double> out,
                                                                point& full, vector& g)
{
    constexpr double most = 1;
    const auto capped = enqueue_capped_values(x, d, fraction, a, most);
    step(x, 1, d, full);
    gradient(full, g);
    const auto norm = reductions_.dot(g.data(), g.data(), space_.size());
    reductions_.fetch();
    return {fold_capped_values(capped, fraction, out, most), reductions_.value(norm)};
}

template <class Element>
void map_objective<Element>::warm_up(const point& x)
{
    auto g = space_.make(), d = space_.make();
    auto y = make_point();
    value_gradient(x, g);
    max_step(x, g);
    const double a[8] = {};
    double e[1];
    values(x, g, std::span(a).first(1), e);
    capped_values(x, g, 0.5, std::span(a).first(1), e);

    space_.axpby(0, g, 0, d);
    space_.dot(g, g);
    step(x, 0, d, y);
    queue_.finish();
}

template <class Element>
void map_objective<Element>::element_gradients(const point& x)
{
    kernels_->gradient(cells(),
                       arrays_->with(x.data(), {{"energy", energies_}, {"corner_gradient", corner_gradients_}}));
    springs_.add_energy(x, energies_);
    springs_.add_gradient(x, corner_gradients_);
}

template <class Element>
solve::impl::model_change map_objective<Element>::move_held(const real_buffer& hessian, const vector& d, vector& g)
{
    const auto sum = enqueue_sum();
    gather_(corner_gradients_, g.data());
    const auto before = reductions_.dot(g.data(), d.data(), space_.size());
    fixed_.add_product(hessian, d, corner_gradients_);
    gather_(corner_gradients_, g.data());
    const auto after = reductions_.dot(g.data(), d.data(), space_.size());
    fixed_.project(g);
    reductions_.fetch();
    return {reductions_.value(sum), (reductions_.value(before) + reductions_.value(after)) / 2};
}

template <class Element>
gather map_objective<Element>::make_gather()
{
    const auto& corners = layout_->vertex_corners;
    const auto rows = static_cast<std::size_t>(layout_->free_count);
    const auto used = static_cast<std::size_t>(corners.offsets[rows]);
    std::vector<idx> cell(used), corner(used);
    parallel_for(used,
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t k = begin; k < end; ++k)
                     {
                         cell[k] = corners.items[k] / Element::corners;
                         corner[k] = corners.items[k] % Element::corners;
                     }
                 });
    return gather(queue_, std::span(corners.offsets).first(rows + 1), cell, corner,
                  {.components = D, .cell_stride = layout_->cell_stride, .vertex_stride = layout_->vertex_stride},
                  types_.position, types_.vector);
}

template <class Element>
auto map_objective<Element>::enqueue_values(const point& x, const vector& d, const real_buffer& unit,
                                            std::span<const double> a) -> sums
{
    sums results;
    for (std::size_t first = 0; first < a.size(); first += kernels::trials)
    {
        const auto step = [&](std::size_t k) { return a[std::min(first + k, a.size() - 1)]; };
        kernels_->along(cells(), arrays_->with(x.data(), {{"d", d.data()},
                                                          {"unit", unit},
                                                          {"energy", energies_},
                                                          {"step0", step(0)},
                                                          {"step1", step(1)},
                                                          {"step2", step(2)},
                                                          {"step3", step(3)}}));
        springs_.add_energies(x, d, unit, std::array{step(0), step(1), step(2), step(3)}, energies_);
        // Commands run in order: the next launch overwrites the energies after they are summed.
        results.push_back(reductions_.sum(energies_, {.count = std::min<std::size_t>(kernels::trials, a.size() - first),
                                                      .length = static_cast<std::size_t>(layout_->cell_count),
                                                      .stride = layout_->cell_stride}));
    }
    return results;
}

template <class Element>
auto map_objective<Element>::enqueue_capped_values(const point& x, const vector& d, double fraction,
                                                   std::span<const double> a, double most) -> capped_sums
{
    const auto least = enqueue_max_step(x, d);
    reductions_.limit(least, fraction, most, limit_);
    return {least, enqueue_values(x, d, limit_, a)};
}

// Compiled once, with the bodies.
extern template class map_objective<triangle>;

} // namespace taut::impl
