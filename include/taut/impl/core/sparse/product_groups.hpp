// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/sparse/transfer_weights.hpp>

namespace taut::impl
{

/// Distribution of the product P' A P over work-items on a CPU: an item sums `size` coarse rows and visits the slices
/// of fine rows that contribute. Nonzeros of a coarse row are told apart by the colours of their columns.
struct product_groups
{
    static constexpr idx clash = 256;
    /// Colours of the columns of P' A P, at most, for K weights per row: stars have many more vertices in space.
    static constexpr idx most_colours(std::size_t K) { return K > 3 ? 256 : 64; }

    /// coarse: the pattern of the product, t: the transpose of P.
    product_groups(const transfer_weights& P, const transposed_weights& t, const block_pattern& coarse,
                   std::size_t rows_a_group)
        : size(rows_a_group)
    {
        colour(coarse, most_colours(P.K));
        code(P);
        visit(P, t, static_cast<std::size_t>(coarse.slice));
    }

    std::size_t size;
    idx count = 0;               ///< of colours
    std::vector<idx> colours;    ///< of coarse columns; those of a row differ, or it has the flag `clash` in its own
    std::vector<idx> codes;      ///< colours of the columns of each fine row, a byte each; 0 for those without a weight
    std::vector<double> weights; ///< of each fine row, four places
    std::vector<idx> offsets, visits; ///< of each group the slices that it visits, and a bit per lane

private:
    /// Greedily, a colouring of the squared graph.
    void colour(const block_pattern& p, idx most)
    {
        using set = std::bitset<most_colours(transfer_weights::most)>;
        colours.assign(p.rows(), 0);
        std::vector<set> used(p.rows()); // colours seen from each row
        const auto C = static_cast<std::size_t>(p.slice);
        for (std::size_t J = 0; J < p.rows(); ++J)
        {
            const std::size_t first = p.place(J, 0), end = first + p.width(J) * C;
            set taken;
            for (std::size_t at = first; at < end; at += C) taken |= used[static_cast<std::size_t>(p.columns[at])];
            idx free = 0;
            while (free < most && taken[static_cast<std::size_t>(free)]) ++free;
            for (std::size_t at = first; at < end; at += C)
            {
                const auto I = static_cast<std::size_t>(p.columns[at]);
                if (free == most)
                    colours[I] |= clash;
                else
                    used[I].set(static_cast<std::size_t>(free));
            }
            if (free == most) continue;
            colours[J] |= free;
            count = std::max(count, free + 1);
        }
    }

    void code(const transfer_weights& P)
    {
        static_assert(transfer_weights::most <= sizeof(idx));
        codes.assign(P.rows(), 0);
        weights.assign(4 * P.rows(), 0);
        const auto some = [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t k = 0; k < P.K; ++k)
                    if (const double w = P.weight(i, k); w != 0)
                    {
                        codes[i] |= colours[P.column(i, k)] % clash << 8 * k;
                        weights[4 * i + k] = w;
                    }
        };
        parallel_for(codes.size(), some);
    }

    void visit(const transfer_weights& P, const transposed_weights& t, std::size_t C)
    {
        const std::size_t groups = (P.coarse + size - 1) / size;
        std::vector<std::vector<idx>> lists(groups);
        const auto some = [&](std::size_t begin, std::size_t end)
        {
            std::vector<idx> lanes(P.rows() / C + 1, 0), slices;
            for (std::size_t g = begin; g < end; ++g)
            {
                slices.clear();
                for (std::size_t J = g * size; J < std::min(P.coarse, (g + 1) * size); ++J)
                    for (const idx place : t[J])
                    {
                        const auto i = transfer_weights::row_of(place);
                        if (lanes[i / C] == 0) slices.push_back(static_cast<idx>(i / C));
                        lanes[i / C] |= idx{1} << i % C;
                    }
                std::sort(slices.begin(), slices.end());
                for (const idx s : slices)
                {
                    lists[g].push_back(s);
                    lists[g].push_back(std::exchange(lanes[static_cast<std::size_t>(s)], 0));
                }
            }
        };
        parallel_for(groups, some, 0, 16);
        offsets.assign(1, 0);
        for (const auto& list : lists)
        {
            visits.insert(visits.end(), list.begin(), list.end());
            offsets.push_back(static_cast<idx>(visits.size()));
        }
    }
};

} // namespace taut::impl
