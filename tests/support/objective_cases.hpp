// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/mips_power.hpp>
#include <taut/any_energy.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/objective/real_types.hpp>

namespace taut::test
{

struct named_energy
{
    std::string name;
    any_energy energy;
};

inline std::vector<named_energy> energies()
{
    using namespace taut::energy;
    return {{"isometric", isometric{}},
            {"shape", shape{}},
            {"area", area{}},
            {"a sum with a user's energy", 0.8 * isometric{} + 0.2 * mips_power{.p = 3}}};
}

/// Arithmetic as a type, for test cases that are templates.
template <precision How>
struct arithmetic
{
    static constexpr bool wide = How == precision::fp64;
    static constexpr double epsilon =
        wide ? std::numeric_limits<double>::epsilon() : std::numeric_limits<float>::epsilon();
    /// Relative error that is allowed against double.
    static constexpr double tolerance = How == precision::fp64 ? 1e-11 : How == precision::mixed ? 2e-5 : 2e-4;
    static impl::real_types types() { return impl::types_of(How); }
};

inline double largest(const std::vector<double>& v)
{
    double most = 0;
    for (const double x : v) most = std::max(most, std::abs(x));
    return most;
}

} // namespace taut::test

TYPE_TO_STRING_AS("double", taut::test::arithmetic<taut::precision::fp64>);
TYPE_TO_STRING_AS("mixed", taut::test::arithmetic<taut::precision::mixed>);
TYPE_TO_STRING_AS("float", taut::test::arithmetic<taut::precision::fp32>);
