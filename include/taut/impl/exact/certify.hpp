// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/parallel.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/exact/branch_edges.hpp>
#include <taut/impl/exact/branch_points.hpp>
#include <taut/impl/exact/predicates.hpp>

namespace taut
{

/// Certificate of local injectivity of a piecewise linear map: no element is flipped, and in the plane no inner vertex
/// is a branch point, one that the map winds around more than once (branch_points.hpp); in space no inner edge is one
/// (branch_edges.hpp). With a simple boundary image the map is injective as a whole.
struct certificate
{
    std::size_t elements = 0; ///< elements examined
    std::size_t flipped = 0;  ///< elements whose determinant is not positive: turned over, flat or not finite; exact
    std::vector<idx> ids{};   ///< the first flipped elements, in ascending order
    std::size_t branched = 0; ///< branch points of a map to the plane, or edges of one to space; exact
    std::vector<idx> branch_ids{}; ///< the first of these vertices, in ascending order; of edges their two ends
    double min_det = 0; ///< smallest det S = mapped / rest measure, signed; 0 if there is no element, NaN if not finite
    double max_det = 0; ///< largest det S

    std::size_t defects() const { return flipped + branched; }

    /// Takes the counts of another certificate; the range of det is kept.
    void take_defects(const certificate& other)
    {
        elements = other.elements;
        flipped = other.flipped;
        ids = other.ids;
        branched = other.branched;
        branch_ids = other.branch_ids;
    }

    explicit operator bool() const { return defects() == 0; }
};

} // namespace taut

namespace taut::impl
{

/// Flip counts of a range of elements.
struct flip_count
{
    std::size_t flipped = 0;
    std::vector<idx> ids;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    bool finite = true;

    void add(idx element, int sign, double det, std::size_t max_ids)
    {
        if (sign <= 0)
        {
            ++flipped;
            if (ids.size() < max_ids) ids.push_back(element);
        }
        if (std::isnan(det)) finite = false;
        least = std::min(least, det);
        most = std::max(most, det);
    }

    /// Adds the counts of the following elements.
    void add(const flip_count& next, std::size_t max_ids)
    {
        flipped += next.flipped;
        const std::size_t room = std::min(max_ids - ids.size(), next.ids.size());
        ids.insert(ids.end(), next.ids.begin(), next.ids.begin() + static_cast<std::ptrdiff_t>(room));
        finite = finite && next.finite;
        least = std::min(least, next.least);
        most = std::max(most, next.most);
    }
};

} // namespace taut::impl

namespace taut
{

/// Counts flipped elements and branch points in exact arithmetic.
///
/// cells:   #F by D + 1 vertex indices, in range; positive orientation means det[x1 - x0, ..., xD - x0] > 0
/// x:       #V image points
/// measure: #F rest areas or volumes, in the same units as x; empty: det is not divided by anything
/// max_ids: maximum number of flipped elements, and of branch points, to list
/// owners:  where elements are the corners of other cells, the cell of each (mesh/cell_corners.hpp)
template <int D>
certificate certify(std::span<const std::array<idx, D + 1>> cells, std::span<const vec<D>> x,
                    std::span<const double> measure = {}, std::size_t max_ids = 16, std::span<const idx> owners = {})
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

// Compiled once, with the bodies.
extern template certificate certify<2>(std::span<const std::array<idx, 3>>, std::span<const vec<2>>,
                                       std::span<const double>, std::size_t, std::span<const idx>);
extern template certificate certify<3>(std::span<const std::array<idx, 4>>, std::span<const vec<3>>,
                                       std::span<const double>, std::size_t, std::span<const idx>);

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/exact/certify.ipp>
#endif
