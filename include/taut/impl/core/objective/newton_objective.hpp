// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/core/energy/definiteness.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/map_objective.hpp>
#include <taut/impl/core/objective/newton_plan.hpp>
#include <taut/impl/core/objective/nonlinear_elimination.hpp>
#include <taut/impl/core/objective/vertex_relaxation.hpp>
#include <taut/impl/core/sparse/block_assembly.hpp>
#include <taut/impl/core/sparse/multigrid.hpp>

namespace taut::impl
{

/// Treatment of elements that cap a step in a newton_objective.
enum class capping_elements
{
    relaxed, ///< newton_objective::relax() moves their vertices
    left     ///< nothing: for energies without a barrier
};

/// The kernels of one energy for Newton's method, traced once, built as one program beside what all energies have, and
/// shared by all levels of a hierarchy. Those that are launched last may be compiled in another process.
template <class Element>
struct newton_kernels
{
    element_kernels<Element> first;
    element_hessian_kernel<Element> second;
    std::optional<relaxation_kernels<Element>> relaxation;

    real_types types;

    newton_kernels(const queue& q, const any_energy& energy, const real_types& of,
                   capping_elements capping = capping_elements::relaxed)
        : newton_kernels(traced(q, energy, of, capping), energy, of, capping)
    {
    }

private:
    static traced_program traced(const queue& q, const any_energy& energy, const real_types& of,
                                 capping_elements capping);

    newton_kernels(const traced_program& p, const any_energy& energy, const real_types& of, capping_elements capping)
        : first(p), second(p), types(of)
    {
        if (relaxes(capping)) relaxation.emplace(p, energy);
    }

    static bool relaxes(capping_elements capping) { return Element::oriented && capping == capping_elements::relaxed; }
};

template <class Element>
traced_program newton_kernels<Element>::traced(const queue& q, const any_energy& energy, const real_types& of,
                                               capping_elements capping)
{
    impl::expect_block_kernels(q, of.vector, Element::dimension);
    const auto form = impl::form_for(q.device());
    auto texts = decltype(first)::record(energy, of, form), common = decltype(first)::record_common(energy, of, form);
    std::vector<std::string> later;
    const auto add = [&](kernel_text text)
    {
        later.push_back(text.name);
        texts.push_back(std::move(text));
    };
    add(decltype(second)::record(energy, of, form));
    if (relaxes(capping))
    {
        for (auto& text : relaxation_kernels<Element>::record(energy, of, form)) add(std::move(text));
        for (auto& text : relaxation_kernels<Element>::record_common(of, form)) common.push_back(std::move(text));
    }
    traced_program p(q, std::move(texts), std::move(common));
    p.share(later);
    return p;
}

/// A map_objective that knows its Hessian (solve/objective.hpp, has_hessian): element Hessians are summed into
/// block-sparse matrices on the device, and a multigrid V-cycle over the hierarchy of the mesh is the preconditioner.
/// The positive semi-definite (projected) Hessian has the eigenvalues of element Hessians filtered, as the energy says.
template <class Element>
class newton_objective : public map_objective<Element>
{
    using base = map_objective<Element>;

public:
    static constexpr int D = Element::dimension;
    using typename base::point;
    using typename base::vector;
    using kernels = newton_kernels<Element>;

    using plan = newton_plan<Element>;

    /// host: made with the lane_form of the queue's device. constraints: besides the pins of the layout.
    newton_objective(queue q, plan host, const any_energy& energy, energy::weighting weights,
                     std::shared_ptr<const kernels> traced, const point_constraints<D>& constraints = {});

    /// Replaces the constraints, as map_objective::constrain.
    void constrain(const point_constraints<D>& c);

    void linearize(const point& x, bool exact);

    /// Linearizes as linearize(x, false), with prescribed displacements towards the targets of aim(): d = a fraction of
    /// the remaining ones there and 0 elsewhere, g = the gradient at x + d in the model. Returns f(x), and the change
    /// of the model along d.
    solve::impl::model_change linearize_towards(const point& x, double share, vector& d, vector& g);
    void hessian_product(const vector& v, vector& out) { (exact_ ? *indefinite_ : cycle_.matrix()).multiply(v, out); }
    /// Applies the V-cycle between two projections where coordinates are fixed: symmetric and positive definite on the
    /// free ones.
    void precondition(const vector& v, vector& out)
    {
        cycle_.apply(v, out);
        this->fixed().project(out);
    }

    /// Preconditioner with its matrices, for measurements.
    const multigrid& preconditioner() const { return cycle_; }

    /// Relaxes the vertices of the worst elements; returns whether there were any.
    bool relax(point& x) { return relaxation_ && (*relaxation_)(x).vertices > 0; }

    /// Eliminates strongly nonlinear parts of a surface; returns whether there were any.
    bool eliminate(point& x, const vector& unexpected, const std::function<bool()>& proceed)
    {
        if constexpr (eliminates) return elimination_ && (*elimination_)(x, unexpected, proceed);
        return false;
    }

    /// Does map_objective::warm_up, and launches the kernels of Newton's method.
    void warm_up(point& x);

private:
    static constexpr bool eliminates = std::is_same_v<Element, triangle>;

    /// The matrices of all levels, of the element Hessians without fixed coordinates.
    void assemble()
    {
        this->fixed().project_hessian(hessian_);
        assemble_(hessian_, cycle_.matrix());
        cycle_.refresh();
    }

    void element_hessians(const point& x, definiteness sign)
    {
        const auto& kernel = kernels_->second;
        kernel.launch(this->cells(), this->arrays()->with(x.data(), {kernel.as_argument(sign), {"hessian", hessian_}}));
        this->springs().add_hessian(hessian_);
    }

    std::shared_ptr<const kernels> kernels_;
    definiteness stand_in_;
    real_buffer hessian_;
    multigrid cycle_;
    block_assembly assemble_;
    std::optional<vertex_relaxation<Element>> relaxation_;
    std::optional<nonlinear_elimination> elimination_;
    std::optional<block_matrix> indefinite_;
    bool exact_ = false;
};

template <class Element>
newton_objective<Element>::newton_objective(queue q, plan host, const any_energy& energy, energy::weighting weights,
                                            std::shared_ptr<const kernels> traced,
                                            const point_constraints<D>& constraints)
    : base(q, host.layout, energy, weights, traced->types,
           std::shared_ptr<const element_kernels<Element>>(traced, &traced->first), constraints),
      kernels_(std::move(traced)),
      stand_in_(definite(energy.eigenvalues())),
      hessian_(q, kernels_->types.vector, hessian_slots<D>::count * host.layout->cell_stride),
      cycle_(q, kernels_->types.vector, std::move(host.cycle)),
      assemble_(cycle_.matrix(), assembly_lists(std::move(host.assembly))) // freed once they are on the device
{
    if (!kernels_->relaxation) return;
    const auto touched = constraints.touched(static_cast<std::size_t>(host.layout->vertex_count));
    relaxation_.emplace(q, host.layout,
                        std::shared_ptr<const relaxation_kernels<Element>>(kernels_, &*kernels_->relaxation),
                        this->arrays(), touched);
    if constexpr (eliminates)
        elimination_.emplace(q, host.layout, this->arrays(), kernels_->first, kernels_->second, kernels_->types,
                             weights, energy, touched);
}

template <class Element>
void newton_objective<Element>::constrain(const point_constraints<D>& c)
{
    base::constrain(c);
    if (!relaxation_) return;
    const auto touched = c.touched(static_cast<std::size_t>(this->layout().vertex_count));
    relaxation_->keep_still(touched);
    if constexpr (eliminates) elimination_->keep_still(touched);
}

template <class Element>
void newton_objective<Element>::linearize(const point& x, bool exact)
{
    element_hessians(x, stand_in_);
    assemble();
    exact_ = exact;
    if (!exact) return;
    if (!indefinite_) indefinite_.emplace(cycle_.matrix().like());
    element_hessians(x, definiteness::indefinite);
    this->fixed().project_hessian(hessian_);
    assemble_(hessian_, *indefinite_);
}

template <class Element>
solve::impl::model_change newton_objective<Element>::linearize_towards(const point& x, double share, vector& d,
                                                                       vector& g)
{
    d.data().fill(0);
    this->fixed().gap(x, share, d);
    this->element_gradients(x);
    element_hessians(x, stand_in_);
    const auto change = this->move_held(hessian_, d, g);
    assemble();
    exact_ = false;
    return change;
}

template <class Element>
void newton_objective<Element>::warm_up(point& x)
{
    base::warm_up(x);
    if (relaxation_) relaxation_->warm_up(x);
    auto v = this->space().make(), w = this->space().make();
    linearize(x, true);
    hessian_product(v, w);
    precondition(v, w);
}

// Compiled once, with the bodies; volume_objective.hpp says so of volumes.
extern template struct newton_kernels<triangle>;
extern template class newton_objective<triangle>;

} // namespace taut::impl
