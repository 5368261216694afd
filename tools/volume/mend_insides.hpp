// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "shared/text_table.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// Solves again with the tetrahedra at the edges of those cells, too, that are negative inside though their corners are
/// positive, or not decided, as long as that leaves fewer of them. again(volume_case, from): the shape with positive
/// simplices that is found from another, or an empty one. x: the shape by then, and the best one afterwards.
/// Returns a note on what was done; empty: nothing was to do.
template <class Element, class Solve>
std::string mend_insides(const volume_case<Element>& input, std::vector<vec<Element::dimension>>& x, const Solve& again)
{
    const auto doubtful = [&](const auto& shape)
    {
        const auto state = input.look(input.as_written(shape));
        auto cells = state.negative_inside;
        cells.insert(cells.end(), state.undecided.begin(), state.undecided.end());
        cells.insert(cells.end(), state.inverted.begin(), state.inverted.end());
        std::sort(cells.begin(), cells.end());
        return cells;
    };
    if (!input.parts().overlapping || x.empty()) return {};
    auto left = doubtful(x);
    if (left.empty()) return {};
    const std::size_t first = left.size();
    std::vector<idx> edged, next = left;
    for (int round = 0; !left.empty() && round < 5; ++round)
    {
        std::vector<idx> all;
        std::set_union(edged.begin(), edged.end(), next.begin(), next.end(), std::back_inserter(all));
        if (all.size() == edged.size()) break; // they have them already
        edged = std::move(all);
        auto shape = again(volume_case<Element>(input.file(), edged), x);
        if (shape.empty()) break;
        next = doubtful(shape); // others may have turned up, which have them in the next round
        if (next.size() >= left.size()) continue;
        left = next;
        x = std::move(shape);
    }
    return count(first, "cell was", "cells were") +
           " negative inside; solved again with the tetrahedra at the edges of " +
           count(edged.size(), "cell", "cells") + ", " + (left.empty() ? "none" : count(left.size())) + " left";
}

} // namespace taut::tools
