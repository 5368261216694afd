// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <taut/impl/core/sparse/transfer_lists.hpp>

namespace taut::impl
{

transfer_lists::transfer_lists(const block_pattern& fine, const transfer_weights& P, const transposed_weights& t,
                               const block_pattern& coarse, lane_form form)
    : K(P.K), fine_stride(fine.stride()), fine_rows(fine.rows()), coarse_rows(coarse.rows())
{
    if (P.rows() != fine_rows || P.coarse != coarse_rows)
        throw parameter_error("transfer_weights", "does not fit the matrices");
    make_prolongation(P);
    make_transpose(P, t, coarse);
    if (form.lanes == 1) return;
    // Large groups share more fine rows; small levels need some groups for all cores.
    constexpr std::size_t few = 32;
    const std::size_t size = std::clamp<std::size_t>(padded(coarse_rows / few, 16), 16, lane_form::product_rows(K));
    groups.emplace(P, t, coarse, size);
}

idx transfer_lists::device_place(idx place) const
{
    const std::size_t k = static_cast<std::size_t>(place) % transfer_weights::most;
    return static_cast<idx>(k * fine_stride + transfer_weights::row_of(place));
}

void transfer_lists::make_prolongation(const transfer_weights& P)
{
    const std::size_t stride = fine_stride;
    columns.assign(K * stride, 0);
    weights.assign(K * stride, 0);
    parallel_for(fine_rows,
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t i = begin; i < end; ++i)
                     {
                         // Places without a weight repeat a column that has one.
                         std::size_t used = 0;
                         while (used + 1 < K && P.weight(i, used) == 0) ++used;
                         for (std::size_t k = 0; k < K; ++k)
                         {
                             const double w = P.weight(i, k);
                             columns[k * stride + i] = P.columns[K * i + (w == 0 ? used : k)];
                             weights[k * stride + i] = w;
                         }
                     }
                 });
}

void transfer_lists::make_transpose(const transfer_weights& P, const transposed_weights& t, const block_pattern& coarse)
{
    const auto C = static_cast<std::size_t>(coarse.slice);
    std::vector<impl::list_chunk> chunks(impl::chunk_count(P.coarse));
    impl::for_each_chunk(P.coarse,
                         [&](std::size_t chunk, std::size_t begin, std::size_t end)
                         {
                             auto& [items, sizes] = chunks[chunk];
                             for (std::size_t first = begin; first < end; first += C)
                             {
                                 const std::size_t last = std::min(first + C, end), base = items.size();
                                 std::size_t width = 0;
                                 for (std::size_t J = first; J < last; ++J) width = std::max(width, t[J].size());
                                 items.resize(base + width * C, -1);
                                 for (std::size_t J = first; J < last; ++J)
                                     for (std::size_t n = 0; n < t[J].size(); ++n)
                                         items[base + n * C + J % C] = device_place(t[J][n]);
                                 sizes.push_back(static_cast<idx>(width * C));
                             }
                         });
    transpose_offsets = impl::slice_offsets(chunks, coarse.stride() / C);
    transpose = impl::joined(chunks);
}

} // namespace taut::impl
