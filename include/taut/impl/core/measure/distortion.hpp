// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include <taut/impl/core/core/block_sum.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

namespace taut::impl
{

/// Arguments of an energy for element c of a map: S = A W^-1 (eq. 3), with A the edges of the image from corner 0.
/// x: #V image points, in the units of `ideal`. The measure is the one of `ideal`.
template <class Element>
element<double, Element::dimension> mapped_element(const mesh<Element>& m, const ideal_elements<Element>& ideal,
                                                   std::span<const vec<Element::dimension>> x, std::size_t c)
{
    constexpr int D = Element::dimension;
    const mat<D> S = shape_matrix<D>(m.cells()[c], x, ideal.inverse[c]);
    return {S, glm::determinant(S), ideal.measure[c]};
}

/// Value of an energy at an element: +infinity beyond its barrier, where the element is flipped or flat.
template <class Energy, int D>
double bounded(const Energy& energy, const element<double, D>& e)
{
    return Energy::barrier && !(e.det > 0) ? std::numeric_limits<double>::infinity() : energy(e);
}

/// Means of a value over elements, unweighted and weighted by the rest measure.
struct means
{
    double uniform = 0; ///< every element counts 1, as in the paper
    double measure = 0; ///< every element counts its rest area or volume

    /// Accumulates sums: adds an element, or other sums; then divides them.
    void add(double value, double by)
    {
        uniform += value;
        measure += value * by;
    }
    means& operator+=(const means& other)
    {
        uniform += other.uniform;
        measure += other.measure;
        return *this;
    }
    means over(std::size_t elements, double total) const
    {
        return {uniform / static_cast<double>(elements), measure / total};
    }
};

/// Computes both means of values, one value and one measure per element.
inline means mean(std::span<const double> value, std::span<const double> measure)
{
    means sums;
    double total = 0;
    for (std::size_t c = 0; c < value.size(); ++c)
    {
        sums.add(value[c], measure[c]);
        total += measure[c];
    }
    return sums.over(value.size(), total);
}

/// Both means of value(element) over the elements of a map.
template <class Element, class Value>
means mean_over(const mesh<Element>& m, const ideal_elements<Element>& ideal,
                std::span<const vec<Element::dimension>> x, const Value& value)
{
    struct sums
    {
        means values;
        double total = 0;
        sums& operator+=(const sums& o)
        {
            values += o.values;
            total += o.total;
            return *this;
        }
    };
    const auto s = impl::block_sum<sums>(m.cells().size(),
                                         [&](sums& part, std::size_t c)
                                         {
                                             const auto e = impl::mapped_element(m, ideal, x, c);
                                             part.values.add(value(e), e.measure);
                                             part.total += e.measure;
                                         });
    return s.values.over(m.cells().size(), s.total);
}

} // namespace taut::impl
