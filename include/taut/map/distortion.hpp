// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/core/parallel.hpp>
#include <taut/energy/isometric.hpp>
#include <taut/mesh/ideal.hpp>

namespace taut
{

/// The map of element c as an energy sees it: S = A W^-1 (eq. 3), with A the edges of the image from corner 0.
/// x: #V image points, in the units of `ideal`. The measure is the one of `ideal`.
template <class Element>
element<double, Element::dimension> mapped_element(const mesh<Element>& m, const ideal_elements<Element>& ideal,
                                                   std::span<const vec<Element::dimension>> x, std::size_t c)
{
    constexpr int D = Element::dimension;
    const auto& cell = m.cells()[c];
    const auto at = [&](std::size_t corner) { return x[static_cast<std::size_t>(cell[corner])]; };
    mat<D> A;
    for (int k = 0; k < D; ++k) A[k] = at(static_cast<std::size_t>(k) + 1) - at(0);
    const mat<D> S = A * ideal.inverse[c];
    return {S, glm::determinant(S), ideal.measure[c]};
}

/// An energy's value for every element: +infinity beyond its barrier, where an element is flipped or flat.
template <class Element, class Energy>
std::vector<double> distortion(const mesh<Element>& m, const ideal_elements<Element>& ideal,
                               std::span<const vec<Element::dimension>> x, const Energy& energy)
{
    std::vector<double> result(m.cells().size());
    parallel_for(result.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         const auto e = mapped_element(m, ideal, x, c);
                         result[c] =
                             Energy::barrier && !(e.det > 0) ? std::numeric_limits<double>::infinity() : energy(e);
                     }
                 });
    return result;
}

/// Isometric distortion of every element, for pictures: 4 (triangles) or 2 (tetrahedra) where nothing is distorted.
template <class Element>
std::vector<double> distortion(const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    return distortion(m, ideal_elements<Element>(m), x, energy::isometric{});
}

/// The two means of a value per element.
struct means
{
    double uniform = 0; ///< every element counts 1, as in the paper
    double measure = 0; ///< every element counts its rest area or volume
};

inline means mean(std::span<const double> value, std::span<const double> measure)
{
    means result;
    double total = 0;
    for (std::size_t c = 0; c < value.size(); ++c)
    {
        result.uniform += value[c];
        result.measure += value[c] * measure[c];
        total += measure[c];
    }
    result.uniform /= static_cast<double>(value.size());
    result.measure /= total;
    return result;
}

} // namespace taut
