// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/energy/eigenvalue_filter.hpp>
#include <taut/impl/energy/element.hpp>
#include <taut/impl/energy/symmetric_matrix.hpp>
#include <taut/impl/symbolic/glm.hpp>

namespace taut
{

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

} // namespace taut

namespace taut::impl
{

/// Default energy: energy::isometric.
any_energy default_energy();

} // namespace taut::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/energy/default_energy.ipp>
#endif
