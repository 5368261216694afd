// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <span>

#include <doctest/doctest.h>

#include <taut/certify.hpp>
#include <taut/untangle.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::test
{

/// Bit for bit: -0.0 is not 0.0.
template <class Element>
bool holds(const untangle_problem<Element>& problem, const untangle_result<Element>& result)
{
    for (std::size_t v = 0; v < problem.held.size(); ++v)
        for (int k = 0; k < Element::dimension; ++k)
            if (problem.held.test(v, k) && std::memcmp(&result.map[v][k], &problem.initial[v][k], sizeof(double)) != 0)
                return false;
    return result.map.size() == problem.initial.size();
}

/// What every outcome owes.
template <class Element>
void check_typed(const untangle_problem<Element>& problem, const untangle_result<Element>& result)
{
    CHECK(holds(problem, result));
    const auto flips =
        certify<Element::dimension>(problem.rest.cells(), std::span<const vec<Element::dimension>>(result.map));
    CHECK(flips.flipped == result.flips.flipped);
    CHECK(flips.branched == result.flips.branched);
    CHECK((result.outcome == outcome::valid) == static_cast<bool>(flips));
    CHECK(static_cast<bool>(result) == result.reason.empty());
    if (!result) CHECK_FALSE(result.ids.empty());
    if (result) CHECK(result.least_relative_det > 0);
}

} // namespace taut::test
