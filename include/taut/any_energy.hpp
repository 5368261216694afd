// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_ANY_ENERGY_HPP
#define TAUT_ANY_ENERGY_HPP

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/check_gradient.hpp>
#include <taut/impl/core/energy/eigenvalue_filter.hpp>
#include <taut/impl/core/energy/element.hpp>
#include <taut/impl/core/energy/symmetric_matrix.hpp>
#include <taut/impl/core/symbolic/apply.hpp>
#include <taut/symbolic.hpp>
#include <taut/traced_vectors.hpp>

/// An energy as a value: chosen at run time, recorded once, and checked.
namespace taut
{

/// A function of one element that is written down operation by operation: for energies that no compiler sees, as those
/// of the Python package. While it is being recorded its tape is current (tape_scope), and the parts of its element
/// are variables of the tape.
///
///     auto r = std::make_shared<energy_recording<2>>();
///     {
///         const tape_scope scope(r->recorded());
///         r->finish(norm2(r->S()) * (1.0 + 1.0 / (r->det() * r->det())));
///     }
///     const any_energy e = recorded_energy(r);
template <int D>
class energy_recording
{
public:
    using real = sym<double>;

    energy_recording()
    {
        const tape_scope scope(tape_);
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) S_[c][r] = real::variable();
        det_ = real::variable();
        measure_ = real::variable();
    }

    tape& recorded() noexcept { return tape_; }

    const glm::mat<D, D, real>& S() const noexcept { return S_; }
    const real& det() const noexcept { return det_; }
    const real& measure() const noexcept { return measure_; }
    real attribute(std::size_t k) { return numbered(attributes_, k); }
    real parameter(std::size_t k) { return numbered(parameters_, k); }

    /// How many of each the function reads.
    std::size_t attributes() const noexcept { return attributes_.size(); }
    std::size_t parameters() const noexcept { return parameters_.size(); }

    /// The value of the function. Throws tape_error for one that is not on the tape.
    void finish(real value)
    {
        root_ = value.id();
        std::vector<char> needed(static_cast<std::size_t>(root_) + 1, 0);
        needed.back() = 1;
        for (impl::node_id id = root_; id >= 0; --id)
            if (needed[static_cast<std::size_t>(id)])
                for (const impl::node_id operand : tape_[id].operands)
                    if (operand != impl::no_node) needed[static_cast<std::size_t>(operand)] = 1;
        order_.clear();
        for (impl::node_id id = 0; id <= root_; ++id)
            if (needed[static_cast<std::size_t>(id)]) order_.push_back(id);
    }

    /// The function of numbers.
    double operator()(const element<double, D>& e) const
    {
        std::vector<std::uint64_t> value(static_cast<std::size_t>(root_) + 1, 0);
        const auto at = [&](impl::node_id id) { return id == impl::no_node ? 0 : value[static_cast<std::size_t>(id)]; };
        for_each_leaf(e,
                      [&](impl::node_id id, double x)
                      {
                          if (id <= root_) value[static_cast<std::size_t>(id)] = impl::to_bits(x);
                      });
        for (const impl::node_id id : order_)
        {
            const impl::node& n = tape_[id];
            if (n.op == impl::opcode::variable) continue;
            if (n.op == impl::opcode::constant)
                value.at(static_cast<std::size_t>(id)) = n.payload;
            else
                value.at(static_cast<std::size_t>(id)) =
                    *impl::apply(n, tape_[n.operands[0]].type, at(n.operands[0]), at(n.operands[1]), at(n.operands[2]));
        }
        return impl::from_bits<double>(at(root_));
    }

    /// The function of traced values, written to the current tape: the same operations in the same order.
    real operator()(const element<real, D>& e) const
    {
        tape& t = tape::current();
        std::vector<impl::node_id> place(static_cast<std::size_t>(root_) + 1, impl::no_node);
        for_each_leaf(e,
                      [&](impl::node_id id, const real& x)
                      {
                          if (id <= root_) place[static_cast<std::size_t>(id)] = x.id();
                      });
        for (const impl::node_id id : order_)
            if (const impl::node& n = tape_[id]; n.op != impl::opcode::variable)
                place[static_cast<std::size_t>(id)] = copied(t, n, place);
        return real::of(place[static_cast<std::size_t>(root_)]);
    }

private:
    real numbered(std::vector<real>& list, std::size_t k)
    {
        const tape_scope scope(tape_);
        while (list.size() <= k) list.push_back(real::variable());
        return list[k];
    }

    /// Calls f(variable, value) with all parts of an element that the function reads. Throws parameter_error where the
    /// element has fewer numbers.
    template <class T, class F>
    void for_each_leaf(const element<T, D>& e, const F& f) const
    {
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) f(S_[c][r].id(), e.S[c][r]);
        f(det_.id(), e.det);
        f(measure_.id(), e.measure);
        for (std::size_t k = 0; k < attributes_.size(); ++k) f(attributes_[k].id(), e.attribute(k));
        for (std::size_t k = 0; k < parameters_.size(); ++k) f(parameters_[k].id(), e.parameter(k));
    }

    /// One operation on another tape, whose real numbers may be in single precision.
    static impl::node_id copied(tape& t, const impl::node& n, const std::vector<impl::node_id>& place)
    {
        if (n.op == impl::opcode::constant)
            return n.type == scalar_type::boolean ? t.constant(n.payload != 0)
                                                  : t.real_constant(impl::from_bits<double>(n.payload));
        const auto at = [&](impl::node_id id)
        { return id == impl::no_node ? impl::no_node : place[static_cast<std::size_t>(id)]; };
        impl::node_id a = at(n.operands[0]), b = at(n.operands[1]), c = at(n.operands[2]);
        scalar_type type = n.type;
        if (n.op == impl::opcode::select)
            type = impl::shared_type(t, b, c);
        else if (t[a].type != scalar_type::boolean)
        {
            const scalar_type real_type = b == impl::no_node ? t[a].type : impl::shared_type(t, a, b);
            if (type != scalar_type::boolean) type = real_type;
        }
        return impl::build(t, n.op, type, a, b, c);
    }

    tape tape_;
    glm::mat<D, D, real> S_;
    real det_, measure_;
    std::vector<real> attributes_, parameters_;
    impl::node_id root_ = 0;
    std::vector<impl::node_id> order_; ///< the operations that the value needs, operands first
};

/// Recordings as an energy, of the plane, of space, or of both. As an any_energy it takes derivatives and becomes
/// kernels as one that is written in C++ does, with the same values bit for bit where its operations are the same.
class recorded_energy
{
public:
    bool barrier = true; ///< +infinity where det S <= 0, which the recording does not say

    recorded_energy(std::shared_ptr<const energy_recording<2>> plane, std::shared_ptr<const energy_recording<3>> space,
                    bool is_barrier = true)
        : barrier(is_barrier), plane_(std::move(plane)), space_(std::move(space))
    {
    }
    explicit recorded_energy(std::shared_ptr<const energy_recording<2>> plane, bool is_barrier = true)
        : recorded_energy(std::move(plane), nullptr, is_barrier)
    {
    }

    /// Throws parameter_error in a dimension without a recording.
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const auto* recording = of_dimension<D>();
        if (!recording) throw parameter_error("energy", "is not defined in dimension " + std::to_string(D));
        return (*recording)(e);
    }

private:
    template <int D>
    const energy_recording<D>* of_dimension() const
    {
        if constexpr (D == 2)
            return plane_.get();
        else
            return space_.get();
    }

    std::shared_ptr<const energy_recording<2>> plane_;
    std::shared_ptr<const energy_recording<3>> space_;
};

/// Treatment of the negative eigenvalues of an element's Hessian, in the space of S, before the change to corners,
/// which keeps their sign.
enum class definiteness
{
    indefinite, ///< kept: the Hessian itself, for the last iterations
    projected,  ///< 0: negative_eigenvalues::clamped
    absolute    ///< without it: negative_eigenvalues::absolute
};

/// Type-erased energy. An energy is traced once per problem, so the indirection costs nothing per element, and
/// functions that take one need not be templates. Converts from every energy_function.
///
/// An energy may exist for triangles, for tetrahedra or for both; calling it in a dimension that it does not have
/// throws parameter_error. One for triangles alone takes element<T, 2>; one that takes element<T, D> is compiled for D
/// = 2 and 3, and its errors in one of them are reported from call() below.
///
/// Numbers that it reads as e.parameter(k) come along: {cloth{}, {0.5}}. They are arguments of its kernels: changing
/// them needs no new kernel.
class any_energy
{
public:
    template <class E>
        requires(!std::same_as<std::remove_cvref_t<E>, any_energy> && energy::impl::energy_of_some_dimension<E>)
    any_energy(E e, std::vector<double> parameters = {})
        : model_(std::make_shared<model<E>>(std::move(e))), parameters_(std::move(parameters))
    {
    }

    /// Says what is missing in one that is no energy.
    template <class E>
        requires(!std::same_as<std::remove_cvref_t<E>, any_energy> && !energy::impl::energy_of_some_dimension<E> &&
                 (std::invocable<const E&, const element<double, 2>&> ||
                  std::invocable<const E&, const element<double, 3>&>))
    any_energy(const E&, std::vector<double> = {})
    {
        static_assert(energy::impl::energy_of_some_dimension<E>,
                      "an energy says where it is infinite: give it `static constexpr bool barrier`, true if it is "
                      "where det S <= 0; and it returns a number");
    }

    /// Returns the energy with other parameters.
    any_energy with_parameters(std::vector<double> parameters) const
    {
        any_energy e = *this;
        e.parameters_ = std::move(parameters);
        return e;
    }
    /// Returns the energy with default values of e.attribute(k), and whether elements have directions (cell_data).
    any_energy with_data(std::vector<double> usual_attributes, bool directions) const
    {
        any_energy e = *this;
        e.attributes_ = std::move(usual_attributes);
        e.directions_ = directions;
        return e;
    }
    /// Returns the energy with another projection of its Hessian where that is not positive semi-definite.
    any_energy with_eigenvalues(impl::negative_eigenvalues treated) const
    {
        any_energy e = *this;
        e.eigenvalues_ = treated;
        return e;
    }
    impl::negative_eigenvalues eigenvalues() const { return eigenvalues_; }

    const std::vector<double>& parameters() const { return parameters_; }
    const std::vector<double>& attributes() const { return attributes_; }
    bool directions() const { return directions_; }

    /// True if the energy is +infinity where det S <= 0.
    bool barrier() const { return model_->barrier(); }

    /// Evaluates the density at one element: a number for T = double, a node of the current tape for T = sym<double>,
    /// in the precision of the recording.
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        if (e.attributes.size() >= attributes_.size() && e.parameters.size() >= parameters_.size())
            return model_->at(e);
        const std::vector<T> attributes(attributes_.begin(), attributes_.end());
        const std::vector<T> parameters(parameters_.begin(), parameters_.end());
        element<T, D> full = e;
        if (full.attributes.empty()) full.attributes = attributes;
        if (full.parameters.empty()) full.parameters = parameters;
        return model_->at(full);
    }

    /// Second derivatives by the entries of S, by columns, filtered, of an energy that provides them, as
    ///
    ///     template <class T>
    ///     symmetric_matrix<T, D * D> hessian(const element<T, D>&, const eigenvalue_filter<T>&, scalar_type) const;
    ///
    /// does, traced; nothing of others. With a filter the result must be positive semi-definite; without, it is the
    /// exact Hessian.
    template <int D>
    std::optional<impl::symmetric_matrix<sym<double>, D * D>>
    hessian(const element<sym<double>, D>& e, const impl::eigenvalue_filter<sym<double>>& filter,
            scalar_type type) const
    {
        return model_->hessian_at(e, filter, type);
    }

private:
    using traced_filter = impl::eigenvalue_filter<sym<double>>;
    template <int D>
    using traced_hessian = std::optional<impl::symmetric_matrix<sym<double>, D * D>>;

    struct interface
    {
        virtual ~interface() = default;
        virtual bool barrier() const = 0;
        virtual double at(const element<double, 2>&) const = 0;
        virtual double at(const element<double, 3>&) const = 0;
        virtual sym<double> at(const element<sym<double>, 2>&) const = 0;
        virtual sym<double> at(const element<sym<double>, 3>&) const = 0;
        virtual traced_hessian<2> hessian_at(const element<sym<double>, 2>&, const traced_filter&,
                                             scalar_type) const = 0;
        virtual traced_hessian<3> hessian_at(const element<sym<double>, 3>&, const traced_filter&,
                                             scalar_type) const = 0;
    };

    template <class E>
    struct model final : interface
    {
        explicit model(E energy) : e(std::move(energy)) {}

        template <int D>
        static constexpr bool is_traceable = !std::invocable<const E&, const element<double, D>&> ||
                                             std::invocable<const E&, const element<sym<double>, D>&>;
        static_assert(
            is_traceable<2> && is_traceable<3>,
            "an energy is traced with scalars other than double: make its operator() a template of the scalar, "
            "and call functions of mathematics without std::");

        template <class T, int D>
        T call(const element<T, D>& x) const
        {
            if constexpr (requires {
                              {
                                  e(x)
                                  } -> std::convertible_to<T>;
                          })
                return e(x);
            else
                throw parameter_error("energy", "is not defined in dimension " + std::to_string(D));
        }

        template <int D>
        traced_hessian<D> own_hessian(const element<sym<double>, D>& x, const traced_filter& f, scalar_type type) const
        {
            if constexpr (requires { e.hessian(x, f, type); })
                return e.hessian(x, f, type);
            else
                return std::nullopt;
        }

        bool barrier() const override { return e.barrier; }
        double at(const element<double, 2>& x) const override { return call(x); }
        double at(const element<double, 3>& x) const override { return call(x); }
        sym<double> at(const element<sym<double>, 2>& x) const override { return call(x); }
        sym<double> at(const element<sym<double>, 3>& x) const override { return call(x); }
        traced_hessian<2> hessian_at(const element<sym<double>, 2>& x, const traced_filter& f,
                                     scalar_type type) const override
        {
            return own_hessian(x, f, type);
        }
        traced_hessian<3> hessian_at(const element<sym<double>, 3>& x, const traced_filter& f,
                                     scalar_type type) const override
        {
            return own_hessian(x, f, type);
        }

        E e;
    };

    std::shared_ptr<const interface> model_;
    impl::negative_eigenvalues eigenvalues_ = impl::negative_eigenvalues::clamped;
    std::vector<double> attributes_, parameters_;
    bool directions_ = false;
};

/// Default energy: energy::isometric.
any_energy default_energy();

/// Checks an energy on random elements of positive determinant: its traced derivative against central differences of
/// its host values, its invariance to rotations of the rest shape's frame, and that a barrier is one. For energies of
/// your own: a tape differentiates what was traced, so a disagreement means that the function branches differently for
/// numbers and for traced scalars (a cast, a table, a branch on T), or that it is not smooth.
template <int D>
impl::gradient_check check_gradient(const any_energy& energy, int trials = 100, unsigned seed = 1)
{
    using real = sym<double>;
    tape recorded;
    const tape_scope scope(recorded);
    std::vector<real> unknowns;
    glm::mat<D, D, real> S;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) unknowns.push_back(S[c][r] = real::variable());
    const real value = energy(element<real, D>{S, glm::determinant(S), real(1.0)});
    const auto partials = differentiate(value, unknowns);

    const auto host = [&](const mat<D>& m) { return energy(element<double, D>{m, glm::determinant(m), 1.0}); };
    const auto largest = [](double so_far, double found)
    { return std::isnan(found) ? std::numeric_limits<double>::infinity() : std::max(so_far, found); };
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-0.6, 0.6);
    impl::gradient_check result;
    while (result.trials < trials)
    {
        mat<D> m(1.0);
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) m[c][r] += entry(random);
        if (glm::determinant(m) < 0.1) continue;
        ++result.trials;
        const double here = host(m), there = host(m * impl::random_rotation<D>(random));
        result.turned = largest(result.turned, std::abs(there - here) / std::max(1.0, std::abs(here)));

        std::vector<binding> bindings;
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) bindings.emplace_back(S[c][r], m[c][r]);
        const auto derivative = evaluate(partials, bindings);
        for (std::size_t k = 0; k < unknowns.size(); ++k)
        {
            constexpr double h = 1e-6;
            const int c = static_cast<int>(k) / D, r = static_cast<int>(k) % D;
            mat<D> up = m, down = m;
            up[c][r] += h;
            down[c][r] -= h;
            const double difference = (host(up) - host(down)) / (2 * h);
            const double error = std::abs(derivative[k] - difference) / std::max(1.0, std::abs(derivative[k]));
            result.worst = largest(result.worst, error);
        }
    }
    const auto at_height = [&](double t)
    {
        mat<D> flat(1.0);
        flat[0][0] = t;
        return host(flat);
    };
    result.barrier = !energy.barrier() || impl::grows_without_bound(at_height);
    return result;
}

} // namespace taut

#endif
#include <taut/impl/leave.inl>
