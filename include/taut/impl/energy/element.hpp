// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <string>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/linalg.hpp>
#include <taut/impl/core/select.hpp> // energies write it in place of `if`

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

namespace taut::energy::impl
{

/// Energy density: a function of one element, smooth where det S > 0. `barrier` says that it tends to infinity as det S
/// tends to 0 from above, and is +infinity (never clamped) from there on.
template <class E, int D = 2>
concept energy_function = requires(const E& e, const element<double, D>& x)
{
    {
        e(x)
        } -> std::convertible_to<double>;
    {
        E::barrier
        } -> std::convertible_to<bool>;
};

template <class E>
concept energy_of_some_dimension = energy_function<E, 2> || energy_function<E, 3>;

} // namespace taut::energy::impl

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

} // namespace taut::energy
