// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/sparse/block_pattern.hpp>

namespace taut
{

/// Weights of a linear interpolation from `coarse` rows, at most three a row; a place with weight 0 does not count. The
/// columns of a row differ where their weights are not 0. It refers to arrays of the caller.
struct transfer_weights
{
    std::span<const std::array<idx, 3>> columns;
    std::span<const std::array<double, 3>> weights;
    std::size_t coarse = 0;      ///< rows of the coarse side
    std::span<const char> fixed; ///< a flag a coarse row, or none: fixed ones neither give nor take corrections
    /// The transpose, or none, and it is made: of coarse row J the places 3 * row + k with a weight, ascending, at
    /// places[offsets[J]] and on.
    std::span<const idx> offsets, places;

    /// The weight of place k of row i, 0 for a fixed column.
    double weight(std::size_t i, std::size_t k) const { return is_fixed(columns[i][k]) ? 0 : weights[i][k]; }
    bool is_fixed(idx J) const { return !fixed.empty() && fixed[static_cast<std::size_t>(J)]; }

    /// Throws parameter_error where the arrays do not fit each other.
    void validate() const
    {
        if (weights.size() != columns.size())
            throw parameter_error("transfer_weights.weights", "needs as many rows as columns");
        if (!fixed.empty() && fixed.size() != coarse)
            throw parameter_error("transfer_weights.fixed", "needs one flag a coarse row, or none");
        if (!offsets.empty() &&
            (offsets.size() != coarse + 1 || static_cast<std::size_t>(offsets.back()) != places.size()))
            throw parameter_error("transfer_weights.offsets", "is not the transpose");
        if (columns.size() > static_cast<std::size_t>(std::numeric_limits<idx>::max()) / 3)
            throw size_error("transfer_weights.columns", "more than 2^31 places");
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (const idx J : columns[i])
                if (J < 0 || static_cast<std::size_t>(J) >= coarse)
                    throw parameter_error("transfer_weights.columns", "row " + std::to_string(i) + " is out of range");
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
        own_offsets_.assign(P.coarse + 1, 0);
        std::size_t count = 0;
        for (std::size_t i = 0; i < P.columns.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                if (P.weights[i][k] != 0) ++own_offsets_[static_cast<std::size_t>(P.columns[i][k])], ++count;
        // Running ends, which filling from the back turns into starts.
        for (std::size_t J = 0, end = 0; J <= P.coarse; ++J)
            own_offsets_[J] = static_cast<idx>(end += static_cast<std::size_t>(own_offsets_[J]));
        own_places_.resize(count);
        for (std::size_t i = P.columns.size(); i-- > 0;)
            for (std::size_t k = 3; k-- > 0;)
                if (P.weights[i][k] != 0)
                    own_places_[static_cast<std::size_t>(--own_offsets_[static_cast<std::size_t>(P.columns[i][k])])] =
                        static_cast<idx>(3 * i + k);
        offsets_ = own_offsets_;
        places_ = own_places_;
    }
    transposed_weights(const transposed_weights&) = delete;
    transposed_weights& operator=(const transposed_weights&) = delete;

    /// The places of coarse row J; none if it is fixed.
    std::span<const idx> operator[](std::size_t J) const
    {
        if (P_->is_fixed(static_cast<idx>(J))) return {};
        return places_.subspan(static_cast<std::size_t>(offsets_[J]),
                               static_cast<std::size_t>(offsets_[J + 1] - offsets_[J]));
    }

private:
    const transfer_weights* P_;
    std::vector<idx> own_offsets_, own_places_;
    std::span<const idx> offsets_, places_;
};

/// The pattern of P' A P, for A of pattern `fine` and t the transpose of P.
inline block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P,
                                        const transposed_weights& t)
{
    if (P.columns.size() != fine.rows()) throw parameter_error("transfer_weights", "does not fit the matrix");
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
                const auto i = static_cast<std::size_t>(place / 3);
                const auto end = static_cast<std::size_t>(fine.offsets[i / C + 1]);
                const std::size_t first = fine.place(i, 0);
                for (std::size_t at = first; at < end; at += C)
                {
                    const idx j = fine.columns[at];
                    if (j == static_cast<idx>(i) && at > first) break;
                    if (met[static_cast<std::size_t>(j)] == static_cast<idx>(I)) continue;
                    met[static_cast<std::size_t>(j)] = static_cast<idx>(I);
                    for (std::size_t l = 0; l < 3; ++l)
                    {
                        const idx J = P.columns[static_cast<std::size_t>(j)][l];
                        if (seen[static_cast<std::size_t>(J)] == static_cast<idx>(I) ||
                            P.weight(static_cast<std::size_t>(j), l) == 0)
                            continue;
                        seen[static_cast<std::size_t>(J)] = static_cast<idx>(I);
                        others.push_back(J);
                    }
                }
            }
        };
    };
    return detail::make_pattern(P.coarse, fine.slice, make_row);
}
inline block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P)
{
    return pattern_of_product(fine, P, transposed_weights(P));
}

} // namespace taut
