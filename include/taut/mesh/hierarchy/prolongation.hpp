// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include <taut/mesh/incidence.hpp>

namespace taut
{

/// Linear interpolation from a coarse level to the next finer one: row i has at most three columns (vertices of the
/// coarse level) with weights >= 0 that sum to 1. Unused places have weight 0 and repeat a used column. The row of a
/// vertex without triangles is 0.
struct prolongation
{
    std::vector<std::array<index, 3>> columns;
    std::vector<std::array<double, 3>> weights;

    /// Of each coarse vertex: the places 3 * row + k with a weight > 0, ascending; what restriction gathers.
    csr transpose;

    index rows() const { return static_cast<index>(columns.size()); }
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

/// coarse = P^T fine.
template <class Value>
void restrict_to(const prolongation& P, std::span<const Value> fine, std::span<Value> coarse)
{
    for (std::size_t j = 0; j < coarse.size(); ++j)
    {
        Value sum{};
        for (const index place : P.transpose.row(static_cast<index>(j)))
            sum = sum + P.weights[static_cast<std::size_t>(place / 3)][static_cast<std::size_t>(place % 3)] *
                            fine[static_cast<std::size_t>(place / 3)];
        coarse[j] = sum;
    }
}

namespace detail
{

/// Fills P.transpose for `count` columns.
inline void transpose(prolongation& P, std::size_t count)
{
    csr& t = P.transpose;
    t.offsets.assign(count + 1, 0);
    std::size_t places = 0;
    for (std::size_t i = 0; i < P.columns.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            if (P.weights[i][k] > 0)
            {
                ++t.offsets[static_cast<std::size_t>(P.columns[i][k])];
                ++places;
            }
    // Running ends, which filling from the back turns into starts.
    for (std::size_t j = 1; j <= count; ++j) t.offsets[j] += t.offsets[j - 1];
    t.items.resize(places);
    for (std::size_t i = P.columns.size(); i-- > 0;)
        for (std::size_t k = 3; k-- > 0;)
            if (P.weights[i][k] > 0)
                t.items[static_cast<std::size_t>(--t.offsets[static_cast<std::size_t>(P.columns[i][k])])] =
                    static_cast<index>(3 * i + k);
}

} // namespace detail

} // namespace taut
