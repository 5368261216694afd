// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <taut/impl/core/measure/shape_quality.hpp>
#include <taut/impl/dist/processes/fixed_sum.hpp>
#include <taut/mesh_piece.hpp>
#include <taut/quality.hpp>

namespace taut::dist::impl
{

/// Shapes of cells, given by the corners of the simplices of a piece; of a cell of several that of its worst corner.
inline std::vector<taut::element_shape> shapes_of_cells(const mesh_piece<tetrahedron>& piece,
                                                        const std::vector<std::array<vec3, 4>>& corners)
{
    const auto& owners = piece.owners;
    std::vector<taut::element_shape> shapes;
    for (std::size_t c = 0; c < corners.size(); ++c)
    {
        const bool joined = c > 0 && !owners.empty() && owners[c - 1] == owners[c];
        const bool followed = c + 1 < owners.size() && owners[c + 1] == owners[c];
        const auto s = joined || followed ? taut::impl::corner_shape(corners[c], piece.edges[c])
                                          : taut::impl::shape_of(corners[c]);
        if (joined)
            shapes.back().join(s);
        else
            shapes.push_back(s);
    }
    return shapes;
}

/// Collective. Shapes of the cells of all processes. corners: of the simplices of the piece. The numbers of the worst
/// are their places among all, by process.
inline taut::shape_quality piece_shapes(const communicator& all, const mesh_piece<tetrahedron>& piece,
                                        const std::vector<std::array<vec3, 4>>& corners)
{
    const auto cells = shapes_of_cells(piece, corners);
    struct ranked
    {
        double mean_ratio;
        std::int64_t cell;
        bool operator<(const ranked& other) const
        {
            return mean_ratio != other.mean_ratio ? mean_ratio < other.mean_ratio : cell < other.cell;
        }
    };
    taut::shape_quality q;
    shared_sums sums(2);
    std::vector<ranked> worst;
    const auto count = static_cast<std::int64_t>(cells.size());
    const std::int64_t before = all.before(count);
    const auto total = static_cast<double>(all.sum(count));
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
        const auto& s = cells[c];
        q.worst.join(s);
        sums[0].add(s.mean_ratio);
        sums[1].add(s.scaled_jacobian);
        worst.push_back({s.mean_ratio, before + static_cast<std::int64_t>(c)});
    }
    const auto first = [](std::vector<ranked> of)
    {
        const auto n = std::min<std::size_t>(10, of.size());
        std::partial_sort(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(n), of.end());
        of.resize(n);
        return of;
    };
    for (const auto& w : first(all.gathered(first(std::move(worst))))) q.worst_ids.push_back(static_cast<idx>(w.cell));
    q.worst.mean_ratio = all.least(q.worst.mean_ratio);
    q.worst.scaled_jacobian = all.least(q.worst.scaled_jacobian);
    q.worst.min_angle = all.least(q.worst.min_angle);
    q.worst.max_angle = all.most(q.worst.max_angle);
    const auto found = sums.totals(all);
    q.mean_ratio = found[0] / total;
    q.scaled_jacobian = found[1] / total;
    return q;
}

} // namespace taut::dist::impl
