// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Disjoint sets of 0 .. n-1 by union-find. The smallest member stands for a set, so results do not depend on the
/// order of joins.
class disjoint_sets
{
public:
    explicit disjoint_sets(idx n) : parent_(static_cast<std::size_t>(n))
    {
        std::iota(parent_.begin(), parent_.end(), idx(0));
    }

    /// The smallest member of the set of i.
    idx find(idx i)
    {
        while (at(i) != i)
        {
            at(i) = at(at(i)); // halve the path
            i = at(i);
        }
        return i;
    }

    /// Joins two sets; false if they were one.
    bool join(idx i, idx j)
    {
        i = find(i);
        j = find(j);
        if (i == j) return false;
        if (j < i) std::swap(i, j);
        at(j) = i;
        return true;
    }

private:
    idx& at(idx i) { return parent_[static_cast<std::size_t>(i)]; }

    std::vector<idx> parent_;
};

} // namespace taut::impl
