// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <taut/types.hpp>

namespace taut::view
{

/// Points and triangles as pages get them: points from an origin nearby, so that floats tell those far from 0 apart.
template <class Point>
std::vector<float> as_floats(const std::vector<Point>& points, const Point& origin)
{
    std::vector<float> list;
    list.reserve(static_cast<std::size_t>(Point::length()) * points.size());
    for (const Point& p : points)
        for (int k = 0; k < Point::length(); ++k) list.push_back(static_cast<float>(p[k] - origin[k]));
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
