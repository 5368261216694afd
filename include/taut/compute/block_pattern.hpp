// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <taut/core/error.hpp>
#include <taut/core/types.hpp>

namespace taut
{

/// The nonzero blocks of a square, structurally symmetric matrix: the columns of row r are columns[offsets[r]] ..
/// columns[offsets[r + 1] - 1], the diagonal first, the others in increasing order.
struct block_pattern
{
    std::vector<index> offsets{0};
    std::vector<index> columns;

    std::size_t rows() const { return offsets.size() - 1; }
    std::size_t length(std::size_t r) const { return static_cast<std::size_t>(offsets[r + 1] - offsets[r]); }
    std::span<const index> row(std::size_t r) const { return {columns.data() + offsets[r], length(r)}; }

    /// The number within its row of column c; length(r) if there is none.
    std::size_t find(std::size_t r, index c) const
    {
        const auto all = row(r);
        if (!all.empty() && all[0] == c) return 0;
        const auto at = std::lower_bound(all.begin() + 1, all.end(), c);
        return at != all.end() && *at == c ? static_cast<std::size_t>(at - all.begin()) : all.size();
    }
};

/// Weights of a linear interpolation, at most three a row; a place with weight 0 does not count. The columns of a row
/// differ where their weights are not 0.
struct transfer_weights
{
    std::vector<std::array<index, 3>> columns;
    std::vector<std::array<double, 3>> weights;
    std::size_t coarse = 0; ///< rows of the coarse side

    /// The places 3 * row + k with a weight, by column, ascending: offsets of coarse + 1 runs, then the places.
    struct transposed
    {
        std::vector<index> offsets, places;
    };
    transposed transpose() const
    {
        transposed t;
        t.offsets.assign(coarse + 1, 0);
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
            {
                if (columns[i][k] < 0 || static_cast<std::size_t>(columns[i][k]) >= coarse)
                    throw parameter_error("transfer_weights.columns", "row " + std::to_string(i) + " is out of range");
                if (weights[i][k] != 0) ++t.offsets[static_cast<std::size_t>(columns[i][k]) + 1];
            }
        for (std::size_t j = 0; j < coarse; ++j) t.offsets[j + 1] += t.offsets[j];
        t.places.resize(static_cast<std::size_t>(t.offsets.back()));
        auto at = t.offsets;
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                if (weights[i][k] != 0)
                    t.places[static_cast<std::size_t>(at[static_cast<std::size_t>(columns[i][k])]++)] =
                        static_cast<index>(3 * i + k);
        return t;
    }
};

namespace detail
{

/// Appends a row: the diagonal, then what `others` holds beside it, sorted.
inline void append_row(block_pattern& p, std::vector<index>& others)
{
    const auto r = static_cast<index>(p.rows());
    std::sort(others.begin(), others.end());
    p.columns.push_back(r);
    for (const index c : others)
        if (c != r) p.columns.push_back(c);
    p.offsets.push_back(static_cast<index>(p.columns.size()));
}

} // namespace detail

/// The pattern of a matrix that is a sum of element matrices. cells: arrays of corner numbers.
template <class Cells>
block_pattern pattern_of_cells(const Cells& cells, std::size_t rows)
{
    std::vector<index> offsets(rows + 1, 0);
    for (const auto& t : cells)
        for (const index v : t) ++offsets[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 0; v < rows; ++v) offsets[v + 1] += offsets[v];
    std::vector<index> around(static_cast<std::size_t>(offsets.back())), at(offsets);
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const index v : cells[c]) around[static_cast<std::size_t>(at[static_cast<std::size_t>(v)]++)] = index(c);

    block_pattern p;
    std::vector<index> seen(rows, -1), others;
    for (std::size_t v = 0; v < rows; ++v)
    {
        others.clear();
        for (index k = offsets[v]; k < offsets[v + 1]; ++k)
            for (const index w : cells[static_cast<std::size_t>(around[static_cast<std::size_t>(k)])])
                if (seen[static_cast<std::size_t>(w)] != static_cast<index>(v))
                {
                    seen[static_cast<std::size_t>(w)] = static_cast<index>(v);
                    others.push_back(w);
                }
        detail::append_row(p, others);
    }
    return p;
}

/// Calls visit(i, j, k, l, J) for each term P(i, I) A(i, j) P(j, J) of row I of P' A P: P(i, I) is place i of the
/// transpose's run, j the j-th nonzero of fine row i, l the place of P in the row of that column.
template <class Visit>
void visit_terms(const block_pattern& fine, const transfer_weights& P, const transfer_weights::transposed& t,
                 std::size_t I, const Visit& visit)
{
    for (index k = t.offsets[I]; k < t.offsets[I + 1]; ++k)
    {
        const auto place = static_cast<std::size_t>(t.places[static_cast<std::size_t>(k)]);
        const std::size_t i = place / 3;
        const double left = P.weights[i][place % 3];
        const auto row = fine.row(i);
        for (std::size_t j = 0; j < row.size(); ++j)
        {
            const auto column = static_cast<std::size_t>(row[j]);
            for (std::size_t l = 0; l < 3; ++l)
                if (P.weights[column][l] != 0) visit(i, j, left * P.weights[column][l], P.columns[column][l]);
        }
    }
}

/// The pattern of P' A P.
inline block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P)
{
    const auto t = P.transpose();
    block_pattern p;
    std::vector<index> seen(P.coarse, -1), others;
    for (std::size_t I = 0; I < P.coarse; ++I)
    {
        others.clear();
        visit_terms(fine, P, t, I,
                    [&](std::size_t, std::size_t, double, index J)
                    {
                        if (seen[static_cast<std::size_t>(J)] == static_cast<index>(I)) return;
                        seen[static_cast<std::size_t>(J)] = static_cast<index>(I);
                        others.push_back(J);
                    });
        detail::append_row(p, others);
    }
    return p;
}

} // namespace taut
