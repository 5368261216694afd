// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/core/csr.hpp>
#include <taut/impl/sparse/block_pattern.hpp>

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
    void validate() const
    {
        if (K < 1 || K > most) throw parameter_error("transfer_weights.K", "must be 1 to 4");
        if (columns.size() % K != 0) throw parameter_error("transfer_weights.columns", "needs K places a row");
        if (weights.size() != columns.size())
            throw parameter_error("transfer_weights.weights", "needs as many places as columns");
        if (!fixed.empty() && fixed.size() != coarse)
            throw parameter_error("transfer_weights.fixed", "needs one flag a coarse row, or none");
        if (!offsets.empty() &&
            (offsets.size() != coarse + 1 || static_cast<std::size_t>(offsets.back()) != places.size()))
            throw parameter_error("transfer_weights.offsets", "is not the transpose");
        if (rows() > static_cast<std::size_t>(std::numeric_limits<idx>::max()) / most)
            throw size_error("transfer_weights.columns", "more than 2^29 rows");
        for (std::size_t at = 0; at < columns.size(); ++at)
            if (columns[at] < 0 || static_cast<std::size_t>(columns[at]) >= coarse)
                throw parameter_error("transfer_weights.columns", "row " + std::to_string(at / K) + " is out of range");
    }
};

/// The transpose of weights, the caller's or made here.
class transposed_weights
{
public:
    explicit transposed_weights(const transfer_weights& P) : P_(&P), offsets_(P.offsets), places_(P.places)
    {
        P.validate();
        if (!P.offsets.empty()) return;
        own_.offsets.assign(P.coarse + 1, 0);
        std::size_t count = 0;
        for (std::size_t at = 0; at < P.columns.size(); ++at)
            if (P.weights[at] != 0) ++own_.offsets[static_cast<std::size_t>(P.columns[at])], ++count;
        // Running ends, which filling from the back turns into starts.
        for (std::size_t J = 0, end = 0; J <= P.coarse; ++J)
            own_.offsets[J] = static_cast<idx>(end += static_cast<std::size_t>(own_.offsets[J]));
        own_.items.resize(count);
        for (std::size_t i = P.rows(); i-- > 0;)
            for (std::size_t k = P.K; k-- > 0;)
                if (P.weights[P.K * i + k] != 0)
                    own_.items[static_cast<std::size_t>(--own_.offsets[P.column(i, k)])] =
                        transfer_weights::place(i, k);
        offsets_ = own_.offsets;
        places_ = own_.items;
    }
    transposed_weights(const transposed_weights&) = delete;
    transposed_weights& operator=(const transposed_weights&) = delete;

    /// The places of coarse row J; none if it is fixed.
    std::span<const idx> operator[](std::size_t J) const
    {
        if (P_->is_fixed(J)) return {};
        return places_.subspan(static_cast<std::size_t>(offsets_[J]),
                               static_cast<std::size_t>(offsets_[J + 1] - offsets_[J]));
    }

private:
    const transfer_weights* P_;
    csr own_;
    std::span<const idx> offsets_, places_;
};

/// The pattern of P' A P, for A of pattern `fine` and t the transpose of P.
inline block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P,
                                        const transposed_weights& t)
{
    if (P.rows() != fine.rows()) throw parameter_error("transfer_weights", "does not fit the matrix");
    const auto C = static_cast<std::size_t>(fine.slice);
    const auto make_row = [&]
    {
        // The last row that met a coarse column, and a fine one: neighbours are met again and again.
        return [&, seen = std::vector<idx>(P.coarse, -1),
                met = std::vector<idx>(fine.rows(), -1)](std::size_t I, std::vector<idx>& others) mutable
        {
            seen[I] = static_cast<idx>(I);
            for (const idx place : t[I])
            {
                const auto i = transfer_weights::row_of(place);
                const auto end = static_cast<std::size_t>(fine.offsets[i / C + 1]);
                const std::size_t first = fine.place(i, 0);
                for (std::size_t at = first; at < end; at += C)
                {
                    const auto j = static_cast<std::size_t>(fine.columns[at]);
                    if (j == i && at > first) break;
                    if (met[j] == static_cast<idx>(I)) continue;
                    met[j] = static_cast<idx>(I);
                    for (std::size_t l = 0; l < P.K; ++l)
                    {
                        const std::size_t J = P.column(j, l);
                        if (seen[J] == static_cast<idx>(I) || P.weight(j, l) == 0) continue;
                        seen[J] = static_cast<idx>(I);
                        others.push_back(static_cast<idx>(J));
                    }
                }
            }
        };
    };
    return impl::make_pattern(P.coarse, fine.slice, make_row);
}
inline block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P)
{
    return pattern_of_product(fine, P, transposed_weights(P));
}

} // namespace taut::impl
