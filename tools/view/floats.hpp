// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <taut/types.hpp>

namespace taut::view
{

/// Points and triangles as pages get them.
inline std::vector<float> as_floats(const std::vector<vec3>& points)
{
    std::vector<float> list;
    list.reserve(3 * points.size());
    for (const vec3& p : points)
        for (int k = 0; k < 3; ++k) list.push_back(static_cast<float>(p[k]));
    return list;
}

template <class Number>
std::vector<std::uint32_t> as_list(const std::vector<std::array<Number, 3>>& faces)
{
    std::vector<std::uint32_t> list;
    list.reserve(3 * faces.size());
    for (const auto& f : faces)
        for (const Number v : f) list.push_back(static_cast<std::uint32_t>(v));
    return list;
}

} // namespace taut::view
