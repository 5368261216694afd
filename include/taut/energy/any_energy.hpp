// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <utility>

#include <taut/energy/element.hpp>
#include <taut/symbolic/glm.hpp>

namespace taut
{

/// Any energy behind one type. An energy is traced once per problem, so the indirection costs nothing per element,
/// and functions that take one need not be templates. Converts from every energy_function.
///
/// An energy may exist for triangles, for tetrahedra or for both; calling it in a dimension that it does not have
/// throws parameter_error. One for triangles alone takes element<T, 2>; one that takes element<T, D> is compiled for D
/// = 2 and 3, and its errors in one of them are reported from call() below.
class any_energy
{
public:
    template <class E>
        requires(!std::same_as<std::remove_cvref_t<E>, any_energy>)
    &&(energy::energy_function<E, 2> || energy::energy_function<E, 3>)any_energy(E e)
        : model_(std::make_shared<model<E>>(std::move(e)))
    {
    }

    /// True if the energy is +infinity where det S <= 0.
    bool barrier() const { return model_->barrier(); }

    /// The density at one element: a number for T = double, a node of the current tape for T = sym<double>, in
    /// the precision of the recording.
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return model_->at(e);
    }

private:
    struct interface
    {
        virtual ~interface() = default;
        virtual bool barrier() const = 0;
        virtual double at(const element<double, 2>&) const = 0;
        virtual double at(const element<double, 3>&) const = 0;
        virtual sym<double> at(const element<sym<double>, 2>&) const = 0;
        virtual sym<double> at(const element<sym<double>, 3>&) const = 0;
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

        bool barrier() const override { return E::barrier; }
        double at(const element<double, 2>& x) const override { return call(x); }
        double at(const element<double, 3>& x) const override { return call(x); }
        sym<double> at(const element<sym<double>, 2>& x) const override { return call(x); }
        sym<double> at(const element<sym<double>, 3>& x) const override { return call(x); }

        E e;
    };

    std::shared_ptr<const interface> model_;
};

} // namespace taut
