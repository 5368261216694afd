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

#include <taut/core/types.hpp>
#include <taut/map/predicates.hpp>

namespace taut
{

/// Whether a piecewise linear map keeps every element's orientation.
struct certificate
{
    std::size_t elements = 0; ///< elements examined
    std::size_t flipped = 0;  ///< elements whose determinant is not positive: turned over, flat or not finite; exact
    std::vector<index> ids;   ///< the first flipped elements, in ascending order
    double min_det = 0; ///< smallest det S = mapped / rest measure, signed; 0 if there is no element, NaN if not finite
    double max_det = 0; ///< largest det S

    /// True if no element is flipped: with a simple boundary image the map is injective (locally, otherwise).
    explicit operator bool() const { return flipped == 0; }
};

/// Counts flipped elements in exact arithmetic.
///
/// cells:   #F by D + 1 vertex indices, in range; positive orientation means det[x1 - x0, ..., xD - x0] > 0
/// x:       #V image points
/// measure: #F rest areas or volumes, in the same units as x; empty: det is not divided by anything
/// max_ids: how many flipped elements to list
template <int D>
certificate certify(std::span<const std::array<index, D + 1>> cells, std::span<const vec<D>> x,
                    std::span<const double> measure = {}, std::size_t max_ids = 16)
{
    constexpr double factorial = D == 2 ? 2 : 6; // edge determinant of a simplex of measure 1
    certificate result;
    result.elements = cells.size();
    if (cells.empty()) return result;
    result.min_det = std::numeric_limits<double>::infinity();
    result.max_det = -std::numeric_limits<double>::infinity();
    bool finite = true;
    for (std::size_t f = 0; f < cells.size(); ++f)
    {
        const orientation o = [&]<std::size_t... K>(std::index_sequence<K...>)
        {
            return orient(x[static_cast<std::size_t>(cells[f][K])]...);
        }
        (std::make_index_sequence<D + 1>{});
        if (o.sign <= 0)
        {
            ++result.flipped;
            if (result.ids.size() < max_ids) result.ids.push_back(static_cast<index>(f));
        }
        const double det = measure.empty() ? o.det : o.det / (measure[f] * factorial);
        if (std::isnan(det)) finite = false;
        result.min_det = std::min(result.min_det, det);
        result.max_det = std::max(result.max_det, det);
    }
    if (!finite) result.min_det = result.max_det = std::numeric_limits<double>::quiet_NaN();
    return result;
}

} // namespace taut
