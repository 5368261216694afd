// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <taut/errors.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/untangle_problem.hpp>

namespace taut
{

template <class Element>
auto untangle_problem<Element>::held_for_sure() const -> impl::fixed_marks<D>
{
    auto marks = held;
    for (const idx v : sliding) marks[static_cast<std::size_t>(v)] = 0;
    return marks;
}

template <class Element>
bool untangle_problem<Element>::outline_pinned() const
{
    const auto outline = impl::boundary_facets(rest, owners);
    return std::all_of(outline.begin(), outline.end(),
                       [this](const auto& facet) {
                           return std::all_of(facet.begin(), facet.end(),
                                              [this](idx v) { return held.all(static_cast<std::size_t>(v)); });
                       });
}

template <class Element>
void untangle_problem<Element>::validate() const
{
    const std::size_t n = rest.points().size();
    if (initial.size() != n)
        throw parameter_error("initial", "one position a vertex: " + std::to_string(n) + ", not " +
                                             std::to_string(initial.size()));
    if (held.size() != n)
        throw parameter_error("held", "one set of coordinates a vertex: " + std::to_string(n) + ", not " +
                                          std::to_string(held.size()));
    if (!draft.empty() && draft.size() != n)
        throw parameter_error("draft", "one position a vertex, or none at all: " + std::to_string(n) + ", not " +
                                           std::to_string(draft.size()));
    const std::size_t cells = rest.cells().size();
    if (!wanted.empty() && wanted.size() != cells)
        throw parameter_error("wanted", "one matrix a cell, or none at all: " + std::to_string(cells) + ", not " +
                                            std::to_string(wanted.size()));
    if (!owners.empty() && owners.size() != cells)
        throw parameter_error("owners", "one per cell, or none at all: " + std::to_string(cells) + ", not " +
                                            std::to_string(owners.size()));
    for (std::size_t v = 0; v < n; ++v)
    {
        for (int k = 0; k < D; ++k)
            if (!std::isfinite(initial[v][k]))
                throw parameter_error("initial", "vertex " + std::to_string(v) + " is not finite");
        if (held[v] > held.every)
            throw parameter_error("held",
                                  "vertex " + std::to_string(v) + " has only " + std::to_string(D) + " coordinates");
    }
}

} // namespace taut

namespace taut
{

template struct untangle_problem<triangle>;
template struct untangle_problem<tetrahedron>;

} // namespace taut
