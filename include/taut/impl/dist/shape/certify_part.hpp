// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/dist.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/dist/processes/part.hpp>
#include <taut/impl/dist/shape/fixed_part.hpp>

namespace taut::dist::impl
{

/// Collective. The certificate of the whole mesh: each element is counted by one process, and each edge (in the plane
/// each vertex) by the owner of its vertex of the least number, which has all elements there.
/// x: D numbers a vertex of the part; measure: of the cells at rest, in the same lengths.
template <class Element>
certificate certify_part(const part<Element>& p, const std::vector<double>& x, const std::vector<double>& measure)
{
    constexpr int D = Element::dimension;
    constexpr std::size_t most_ids = 16;
    certificate all;
    std::vector<std::int64_t> flipped, branches;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    bool finite = true;
    p.all.together(
        [&]
        {
            std::vector<vec<D>> points(p.size());
            for (std::size_t v = 0; v < points.size(); ++v)
                for (int k = 0; k < D; ++k) points[v][k] = x[D * v + static_cast<std::size_t>(k)];
            const auto owned = [&](idx v) { return p.owns(v); };
            if (p.corners.empty()) return;
            const auto here = certify<D>(std::span(p.corners), std::span<const vec<D>>(points), measure,
                                         8 * p.corners.size(), p.owners);
            least = here.min_det;
            most = here.max_det;
            finite = std::isfinite(least) && std::isfinite(most);
            for (const idx c : here.ids)
                if (p.counted[static_cast<std::size_t>(c)]) flipped.push_back(p.cell_ids[static_cast<std::size_t>(c)]);
            // As in the certificate of one process, in space they are looked for where nothing is inverted.
            constexpr std::size_t ends = D - 1; // of an edge; in the plane a vertex is its own
            for (std::size_t k = 0; k + ends <= here.branch_ids.size(); k += ends)
            {
                const idx first = here.branch_ids[k], last = here.branch_ids[k + ends - 1];
                const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(last);
                if (!owned(p.numbers[a] < p.numbers[b] ? first : last)) continue;
                branches.push_back(p.ids[a]);
                if (D == 3) branches.push_back(p.ids[b]);
            }
        });
    constexpr std::int64_t of_branch = D == 2 ? 1 : 2; // ids
    all.elements = p.cells;
    all.flipped = p.all.sum(static_cast<std::int64_t>(flipped.size()));
    if (D == 3 && all.flipped > 0) branches.clear();
    all.branched = p.all.sum(static_cast<std::int64_t>(branches.size())) / of_branch;
    const auto first_of_all = [&](std::vector<std::int64_t> ids, std::size_t group)
    {
        ids.resize(std::min(ids.size(), group * most_ids));
        ids = p.all.gathered(ids);
        if (group == 1) std::sort(ids.begin(), ids.end());
        ids.resize(std::min(ids.size(), group * most_ids));
        return ids;
    };
    std::sort(flipped.begin(), flipped.end());
    if (all.flipped > 0) all.ids = first_of_all(std::move(flipped), 1);
    if (all.branched > 0) all.branch_ids = first_of_all(std::move(branches), of_branch);
    all.min_det = p.all.least(finite ? least : -std::numeric_limits<double>::infinity());
    all.max_det = p.all.most(finite ? most : std::numeric_limits<double>::infinity());
    if (p.all.any(!finite && !p.corners.empty())) all.min_det = all.max_det = std::numeric_limits<double>::quiet_NaN();
    return all;
}

/// Collective. Elements that are inverted or flat whatever else moves, as all their vertices are pinned: their number,
/// and the first of them. x: D numbers a vertex of the part, of pinned ones their targets.
template <class Element>
certificate pinned_inverted(const part<Element>& p, const fixed_part<Element>& held, const std::vector<double>& x)
{
    constexpr int D = Element::dimension;
    std::vector<std::int64_t> ids;
    p.all.together(
        [&]
        {
            for (std::size_t c = 0; c < p.corners.size(); ++c)
            {
                const auto& cell = p.corners[c];
                if (!p.counted[c] || !std::all_of(cell.begin(), cell.end(),
                                                  [&](idx v) { return held.pinned(static_cast<std::size_t>(v)); }))
                    continue;
                std::array<vec<D>, part<Element>::K> corners;
                for (std::size_t k = 0; k < corners.size(); ++k)
                    for (int i = 0; i < D; ++i) corners[k][i] = x[static_cast<std::size_t>(D * cell[k] + i)];
                if (std::apply([](const auto&... at) { return taut::impl::orient(at...).sign; }, corners) <= 0)
                    ids.push_back(p.cell_ids[c]);
            }
        });
    certificate found{.elements = p.cells, .flipped = p.all.sum(static_cast<std::int64_t>(ids.size()))};
    if (found.flipped == 0) return found;
    std::sort(ids.begin(), ids.end());
    ids.resize(std::min<std::size_t>(ids.size(), 16));
    found.ids = p.all.gathered(ids);
    std::sort(found.ids.begin(), found.ids.end());
    found.ids.resize(std::min<std::size_t>(found.ids.size(), 16));
    return found;
}

} // namespace taut::dist::impl
