// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_ENERGIES_HPP
#define TAUT_ENERGIES_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include <taut/errors.hpp>
#include <taut/impl/core/energy/invariants.hpp>
#include <taut/types.hpp>

/// Energies that come along, and the element that an energy is a function of.
namespace taut
{

/// Arguments of an energy, for one element. T is double, or a traced scalar when the energy becomes a kernel.
template <class T, int D>
struct element
{
    /// Shape matrix A W^-1 from the ideal to the physical element (eq. 3); a rotation at rest. Its frame is the
    /// element's own (the first column is the image of the first edge), so an energy must not see turns of it:
    /// E(S R) = E(S) for every rotation R; or it is given by cell_data::directions, whose image the first column then
    /// is.
    glm::mat<D, D, T> S;
    T det;     ///< det S = signed mapped measure / rest measure
    T measure; ///< rest area or volume, in the units of the normalised mesh (total = number of elements)

    std::span<const T> attributes = {}; ///< the user's numbers of this element (cell_data::attributes)
    std::span<const T> parameters = {}; ///< the user's numbers for all elements (any_energy::with)

    /// Number k of each. Throws parameter_error where there are fewer.
    T attribute(std::size_t k) const { return pick(attributes, k, "attributes"); }
    T parameter(std::size_t k) const { return pick(parameters, k, "parameters"); }

private:
    static T pick(std::span<const T> numbers, std::size_t k, const char* what)
    {
        if (k >= numbers.size())
            throw parameter_error(what, "the energy reads number " + std::to_string(k) + ", and " +
                                            std::to_string(numbers.size()) + " are given");
        return numbers[k];
    }
};

} // namespace taut

namespace taut::energy
{

/// Weights of the sum over elements. The paper sums with weight 1; the field has since weighted by the rest measure.
enum class weighting
{
    uniform, ///< every element counts 1
    measure  ///< an element counts its rest area or volume
};

/// Value of an energy at a rotation. For the energies of this library it is the minimum.
template <int D, class E>
double rest_value(const E& e)
{
    return e(element<double, D>{mat<D>(1.0), 1.0, 1.0});
}

/// Conformal distortion |S|^2 / (D det(S)^(2/D)): 1 at similarities, blind to scale (eq. 4). Half of MIPS (eq. 16).
/// Eq. 11 drops the 1/2 that eq. 4 has for D = 2; here D = 2 keeps it.
struct shape
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        using std::pow;
        if constexpr (D == 2)
            return norm2(e.S) / (T(2) * e.det);
        else
            return norm2(e.S) / (T(D) * pow(e.det, T(2.0 / D)));
    }
};

/// Area (volume) distortion det S + 1/det S: 2 where the measure is kept, blind to shape (eq. 18).
struct area
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return e.det + T(1) / e.det;
    }
};

/// Isometric distortion, minimal exactly at rotations.
/// D = 2: |S|^2 (1 + 1/det^2), the symmetric Dirichlet energy, minimum 4. It is eq. 19 with the squares that the print
/// drops, and twice shape x area (eqs. 4, 18).
/// D = 3: shape x area, minimum 2. (Eq. 19 taken over literally would be minimal at a dilation of 2^(1/6).)
struct isometric
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        if constexpr (D == 2)
            return norm2(e.S) * (T(1) + T(1) / (e.det * e.det));
        else
            return shape{}(e)*area{}(e);
    }

    /// In the plane, by the invariants I = |S|^2 and d = det S: where the energy itself is not traced.
    template <class T>
    static taut::impl::invariant_derivatives<T> derivatives(const T& I, const T& d)
    {
        const T r = T(1) / d, r2 = r * r;
        return {I, d, T(1) + r2, T(-2) * I * r2 * r, T(0), T(-2) * r2 * r, T(6) * I * r2 * r2};
    }
};

/// Shape energy raised to a power: the larger it is, the more the worst elements count. 1 at similarities.
struct shape_power
{
    static constexpr bool barrier = true;

    int power = 2; ///< at least 1

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const T once = shape{}(e);
        T all = once;
        for (int k = 1; k < power; ++k) all = all * once;
        return all;
    }
};

/// Strain energy density of a compressible neo-Hookean solid of Young's modulus 1 (Bonet and Wood, Nonlinear Continuum
/// Mechanics for Finite Element Analysis, eq. 6.27): mu / 2 (|S|^2 - D - 2 log J) + lambda / 2 (log J)^2, J = det S. 0
/// at rotations; in the plane, plane strain.
struct neo_hookean
{
    static constexpr bool barrier = true;

    double poisson = 0.3; ///< ratio, in (-1, 0.5); near 0.5 volumes are kept, and linear tetrahedra lock

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const auto lame = of_poisson(poisson);
        return density(e, lame[0], lame[1]);
    }

    /// mu and lambda for a Poisson ratio, at Young's modulus 1.
    static std::array<double, 2> of_poisson(double ratio)
    {
        return {0.5 / (1 + ratio), ratio / ((1 + ratio) * (1 - 2 * ratio))};
    }

    /// With these mu and lambda.
    template <class T, int D, class Number>
    static T density(const element<T, D>& e, const Number& mu, const Number& lambda)
    {
        using std::log;
        const T log_j = log(e.det);
        return T(0.5 * mu) * (norm2(e.S) - T(double(D)) - T(2) * log_j) + T(0.5 * lambda) * log_j * log_j;
    }
};

/// Neo-Hookean energy with mu = e.parameter(0) and lambda = e.parameter(1), as neo_hookean::of_poisson() gives them:
/// changing them needs no new kernel.
struct neo_hookean_of_parameters
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return neo_hookean::density(e, e.parameter(0), e.parameter(1));
    }
};

} // namespace taut::energy

#endif
#include <taut/impl/leave.inl>
