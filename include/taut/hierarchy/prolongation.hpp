// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/mesh/incidence.hpp>

namespace taut
{

/// Linear interpolation from a coarse level to the next finer one: row i has at most three columns (vertices of the
/// coarse level) with weights >= 0 that sum to 1. Unused places have weight 0 and repeat a used column. The row of a
/// vertex without triangles is 0.
struct prolongation
{
    std::vector<std::array<idx, 3>> columns;
    std::vector<std::array<double, 3>> weights;

    /// Of each coarse vertex: the places 3 * row + k with a weight > 0, ascending; what restriction gathers.
    csr transpose;

    idx rows() const { return static_cast<idx>(columns.size()); }
};

/// fine = P coarse. Values need + and multiplication by double.
template <class Value>
void prolong(const prolongation& P, std::span<const Value> coarse, std::span<Value> fine)
{
    for (std::size_t i = 0; i < P.columns.size(); ++i)
    {
        const auto& [a, b, c] = P.columns[i];
        const auto& w = P.weights[i];
        fine[i] = w[0] * coarse[static_cast<std::size_t>(a)] + w[1] * coarse[static_cast<std::size_t>(b)] +
                  w[2] * coarse[static_cast<std::size_t>(c)];
    }
}

namespace detail
{

/// Fills P.transpose for `count` columns.
inline void transpose(prolongation& P, std::size_t count, unsigned threads = 0)
{
    // Places without a weight go to a bucket behind the columns, which is cut off.
    std::vector<idx> places(3 * P.columns.size());
    auto start = counting_sort(
        places.size(), count + 1,
        [&](std::size_t place)
        { return P.weights[place / 3][place % 3] > 0 ? P.columns[place / 3][place % 3] : static_cast<idx>(count); },
        [&](std::size_t place, std::size_t position) { places[position] = static_cast<idx>(place); }, threads);
    start.pop_back();
    places.resize(static_cast<std::size_t>(start.back()));
    places.shrink_to_fit();
    P.transpose = {std::move(start), std::move(places)};
}

} // namespace detail

} // namespace taut
