// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/branch_edges.hpp>
#include <taut/impl/core/exact/certify.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut
{

template <int D>
certificate certify(std::span<const std::array<idx, D + 1>> cells, std::span<const vec<D>> x,
                    std::span<const double> measure, std::size_t max_ids, std::span<const idx> owners)
{
    constexpr double factorial = D == 2 ? 2 : 6; // edge determinant of a simplex of measure 1
    if (cells.empty()) return {};
    const auto det_at = [&]<std::size_t... K>(std::size_t f, std::index_sequence<K...>)
    {
        return impl::orient(x[static_cast<std::size_t>(cells[f][K])]...);
    };
    constexpr std::size_t block = 4096;
    std::vector<impl::flip_count> parts((cells.size() + block - 1) / block);
    impl::parallel_for(
        parts.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t b = begin; b < end; ++b)
                for (std::size_t f = b * block; f < std::min(cells.size(), (b + 1) * block); ++f)
                {
                    const impl::orientation o = det_at(f, std::make_index_sequence<D + 1>{});
                    const double det = measure.empty() ? o.det : o.det / (measure[f] * factorial);
                    parts[b].add(static_cast<idx>(f), o.sign, det, max_ids);
                }
        },
        0, 2);
    impl::flip_count all;
    for (const auto& part : parts) all.add(part, max_ids);
    if (!all.finite) all.least = all.most = std::numeric_limits<double>::quiet_NaN();
    certificate result{.elements = cells.size(),
                       .flipped = all.flipped,
                       .ids = std::move(all.ids),
                       .min_det = all.least,
                       .max_det = all.most};
    if constexpr (D == 2)
    {
        result.branch_ids = branch_points(cells, x, owners);
        result.branched = result.branch_ids.size();
        result.branch_ids.resize(std::min(max_ids, result.branched));
    }
    else if (result.flipped == 0)
    {
        const auto edges = impl::branch_edges(cells, x, owners);
        result.branched = edges.size();
        for (std::size_t e = 0; e < std::min(max_ids, edges.size()); ++e)
            result.branch_ids.insert(result.branch_ids.end(), edges[e].begin(), edges[e].end());
    }
    return result;
}

} // namespace taut

namespace taut
{

template certificate certify<2>(std::span<const std::array<idx, 3>>, std::span<const vec<2>>, std::span<const double>,
                                std::size_t, std::span<const idx>);
template certificate certify<3>(std::span<const std::array<idx, 4>>, std::span<const vec<3>>, std::span<const double>,
                                std::size_t, std::span<const idx>);

} // namespace taut
