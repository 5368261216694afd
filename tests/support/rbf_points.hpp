// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <taut/impl/charts/paste/rbf_basis.hpp>
#include <taut/types.hpp>

namespace taut::test
{

inline constexpr impl::rbf_basis all_bases[] = {impl::rbf_basis::linear, impl::rbf_basis::cubic,
                                                impl::rbf_basis::thin_plate, impl::rbf_basis::wendland_c2,
                                                impl::rbf_basis::wendland_c4};

/// Points at random in a box about the origin, `size` long on each side.
inline std::vector<vec3> scattered_points(std::size_t n, std::uint32_t seed, double size = 1)
{
    std::mt19937 random(seed);
    const auto uniform = [&] { return size * (double(random()) / 4294967296.0 - 0.5); };
    std::vector<vec3> points(n);
    for (vec3& p : points)
        for (int k = 0; k < 3; ++k) p[k] = uniform();
    return points;
}

} // namespace taut::test
