// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

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
