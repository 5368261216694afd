// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/incidence.hpp>

namespace taut::impl
{

/// Linear interpolation from a coarse level to the next finer one: row i has at most K columns (vertices of the coarse
/// level, corners of a cell) with weights that sum to 1, none of them negative on surfaces. Unused places have weight 0
/// and repeat a used column. The row of a vertex without cells is 0.
template <std::size_t K>
struct prolongation
{
    std::vector<std::array<idx, K>> columns;
    std::vector<std::array<double, K>> weights;

    /// Transpose for restriction: of each coarse vertex the places 4 * row + k with a weight, ascending. 4 for any K,
    /// so that readers need no division.
    csr transpose;

    idx rows() const { return static_cast<idx>(columns.size()); }
};

/// fine = P coarse. Values need +, += and multiplication by double.
template <std::size_t K, class Value>
void prolong(const prolongation<K>& P, std::span<const Value> coarse, std::span<Value> fine)
{
    for (std::size_t i = 0; i < P.columns.size(); ++i)
    {
        const auto term = [&](std::size_t k)
        { return P.weights[i][k] * coarse[static_cast<std::size_t>(P.columns[i][k])]; };
        fine[i] = term(0);
        for (std::size_t k = 1; k < K; ++k) fine[i] += term(k);
    }
}

/// Fills P.transpose for `count` columns. K is at most 4.
template <std::size_t K>
void transpose(prolongation<K>& P, std::size_t count, unsigned threads = 0)
{
    // Places without a weight go to a bucket behind the columns, which is cut off.
    std::vector<idx> places(K * P.columns.size());
    auto start = counting_sort(
        places.size(), count + 1,
        [&](std::size_t place)
        { return P.weights[place / K][place % K] != 0 ? P.columns[place / K][place % K] : static_cast<idx>(count); },
        [&](std::size_t place, std::size_t position)
        { places[position] = static_cast<idx>(4 * (place / K) + place % K); },
        threads);
    start.pop_back();
    places.resize(static_cast<std::size_t>(start.back()));
    places.shrink_to_fit();
    P.transpose = {std::move(start), std::move(places)};
}

} // namespace taut::impl
