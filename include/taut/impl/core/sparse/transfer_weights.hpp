// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/sparse/block_pattern.hpp>

namespace taut::impl
{

/// Weights of a linear interpolation from `coarse` rows, at most K per row: K corners of a simplex of the coarse level.
/// A place with weight 0 does not count. The columns of a row differ where their weights are not 0. It refers to arrays
/// of the caller.
struct transfer_weights
{
    static constexpr std::size_t most = 4; ///< corners of a tetrahedron

    std::size_t K = 0;                    ///< places per row, at most `most`
    std::span<const idx> columns = {};    ///< at [K * row + k]
    std::span<const double> weights = {}; ///< alike
    std::size_t coarse = 0;               ///< rows of the coarse side
    std::span<const char> fixed = {}; ///< a flag per coarse row, or none: fixed ones neither give nor take corrections
    /// The transpose, or none, and it is made: of coarse row J the places `most` * row + k with a weight, ascending, at
    /// places[offsets[J]] and on.
    std::span<const idx> offsets = {}, places = {};

    /// Transfer weights of rows that are arrays, without the transpose.
    template <std::size_t Width>
    static transfer_weights of_rows(const std::vector<std::array<idx, Width>>& columns,
                                    const std::vector<std::array<double, Width>>& weights, std::size_t coarse,
                                    std::span<const char> fixed = {})
    {
        static_assert(Width <= most);
        transfer_weights P{.K = Width, .coarse = coarse, .fixed = fixed};
        if (!columns.empty()) P.columns = {columns.front().data(), Width * columns.size()};
        if (!weights.empty()) P.weights = {weights.front().data(), Width * weights.size()};
        return P;
    }

    std::size_t rows() const { return columns.size() / K; }
    std::size_t column(std::size_t i, std::size_t k) const { return static_cast<std::size_t>(columns[K * i + k]); }
    /// The weight of place k of row i, 0 for a fixed column.
    double weight(std::size_t i, std::size_t k) const { return is_fixed(column(i, k)) ? 0 : weights[K * i + k]; }
    bool is_fixed(std::size_t J) const { return !fixed.empty() && fixed[J]; }

    static idx place(std::size_t i, std::size_t k) { return static_cast<idx>(most * i + k); }
    static std::size_t row_of(idx place) { return static_cast<std::size_t>(place) / most; }

    /// Throws parameter_error where the arrays do not fit each other.
    void validate() const;
};

/// The transpose of weights, the caller's or made here.
class transposed_weights
{
public:
    explicit transposed_weights(const transfer_weights& P);
    transposed_weights(const transposed_weights&) = delete;
    transposed_weights& operator=(const transposed_weights&) = delete;

    /// The places of coarse row J; none if it is fixed.
    std::span<const idx> operator[](std::size_t J) const;

private:
    const transfer_weights* P_;
    csr own_;
    std::span<const idx> offsets_, places_;
};

/// The pattern of P' A P, for A of pattern `fine` and t the transpose of P.
block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P, const transposed_weights& t);
inline block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P)
{
    return pattern_of_product(fine, P, transposed_weights(P));
}

} // namespace taut::impl
