// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>

#include <taut/impl/core/sparse/transfer_weights.hpp>

namespace taut::impl
{

void transfer_weights::validate() const
{
    if (K < 1 || K > most) throw parameter_error("transfer_weights.K", "must be 1 to 4");
    if (columns.size() % K != 0) throw parameter_error("transfer_weights.columns", "needs K places a row");
    if (weights.size() != columns.size())
        throw parameter_error("transfer_weights.weights", "needs as many places as columns");
    if (!fixed.empty() && fixed.size() != coarse)
        throw parameter_error("transfer_weights.fixed", "needs one flag a coarse row, or none");
    if (!offsets.empty() && (offsets.size() != coarse + 1 || static_cast<std::size_t>(offsets.back()) != places.size()))
        throw parameter_error("transfer_weights.offsets", "is not the transpose");
    if (rows() > static_cast<std::size_t>(std::numeric_limits<idx>::max()) / most)
        throw size_error("transfer_weights.columns", "more than 2^29 rows");
    for (std::size_t at = 0; at < columns.size(); ++at)
        if (columns[at] < 0 || static_cast<std::size_t>(columns[at]) >= coarse)
            throw parameter_error("transfer_weights.columns", "row " + std::to_string(at / K) + " is out of range");
}

transposed_weights::transposed_weights(const transfer_weights& P) : P_(&P), offsets_(P.offsets), places_(P.places)
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
                own_.items[static_cast<std::size_t>(--own_.offsets[P.column(i, k)])] = transfer_weights::place(i, k);
    offsets_ = own_.offsets;
    places_ = own_.items;
}

std::span<const idx> transposed_weights::operator[](std::size_t J) const
{
    if (P_->is_fixed(J)) return {};
    return places_.subspan(static_cast<std::size_t>(offsets_[J]),
                           static_cast<std::size_t>(offsets_[J + 1] - offsets_[J]));
}

block_pattern pattern_of_product(const block_pattern& fine, const transfer_weights& P, const transposed_weights& t)
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

} // namespace taut::impl
