// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <taut/mesh/ideal.hpp>

namespace taut
{

/// The smallest multiple of `step` that is not below n.
constexpr std::size_t round_up(std::size_t n, std::size_t step)
{
    return (n + step - 1) / step * step;
}

/// Lengthens cells and ideal elements to a multiple of `step`, so that a kernel needs no bounds test: copies of the
/// last cell with measure 0. Their energy is as finite as that cell's and counts nothing, and no step they allow is
/// shorter. (A cell with repeated vertices would have det 0: an infinite energy, and 0 * infinity.)
template <class Element>
void pad(std::vector<typename mesh<Element>::cell>& cells, ideal_elements<Element>& ideals, std::size_t step)
{
    const std::size_t n = round_up(cells.size(), step);
    cells.resize(n, cells.back());
    ideals.inverse.resize(n, ideals.inverse.back());
    ideals.measure.resize(n, 0.0);
}

} // namespace taut
