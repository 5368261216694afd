// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/elements.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Mean directions of the axes x, y, z of space in a map: component k is the integral over the surface of the image of
/// axis k, projected to the surface, as a complex number. It rotates with the map.
inline std::array<std::complex<double>, 3> images_of_axes(const mesh<triangle>& m, std::span<const vec2> uv)
{
    std::array<std::complex<double>, 3> images;
    for (const auto& t : m.cells())
    {
        const auto p = [&](std::size_t k) { return m.points()[static_cast<std::size_t>(t[k])]; };
        const auto q = [&](std::size_t k) { return uv[static_cast<std::size_t>(t[k])]; };
        const vec3 across = glm::cross(p(1) - p(0), p(2) - p(0));
        const double twice_area = glm::length(across);
        if (!(twice_area > 0)) continue; // too small to count
        const vec3 normal = across / twice_area;
        // Area times gradient of the basis functions of corners 1 and 2; that of corner 0 is minus their sum.
        const vec3 one = glm::cross(normal, p(0) - p(2)) / 2.0, two = glm::cross(normal, p(1) - p(0)) / 2.0;
        const vec2 to_one = q(1) - q(0), to_two = q(2) - q(0);
        for (int k = 0; k < 3; ++k)
            images[static_cast<std::size_t>(k)] +=
                std::complex<double>(to_one.x * one[k] + to_two.x * two[k], to_one.y * one[k] + to_two.y * two[k]);
    }
    return images;
}

/// Direction of a map's longer principal axis, from the broad end to the thin one, as a complex number.
inline std::complex<double> principal_direction(const mesh<triangle>& m, std::span<const vec2> uv)
{
    struct lump
    {
        std::complex<double> at;
        double area;
    };
    std::vector<lump> lumps;
    std::complex<double> centre, second;
    double total = 0, third = 0;
    for (const auto& t : m.cells())
    {
        const auto q = [&](std::size_t k) { return uv[static_cast<std::size_t>(t[k])]; };
        const vec2 middle = (q(0) + q(1) + q(2)) / 3.0;
        lumps.push_back({{middle.x, middle.y}, triangle::measure_factor * triangle::determinant({q(0), q(1), q(2)})});
        total += lumps.back().area;
        centre += lumps.back().area * lumps.back().at;
    }
    centre /= total;
    for (const auto& [at, area] : lumps) second += area * (at - centre) * (at - centre);
    const auto axis = std::polar(1.0, std::arg(second) / 2);
    for (const auto& [at, area] : lumps) third += area * std::pow(((at - centre) * std::conj(axis)).real(), 3);
    return third < 0 ? -axis : axis;
}

/// Rotation, as a complex number, that puts a map upright: the first of the axes y, x, z whose mean direction is at
/// least half as long as the longest one points up if it is y or z, and to the right if it is x. Where none has a mean
/// direction (a torus cut open), the longer principal axis is along u. It depends on the surface and the map alone, and
/// continuously except where the choice of the axis changes.
inline std::complex<double> upright_turn(const mesh<triangle>& m, std::span<const vec2> uv)
{
    const auto images = images_of_axes(m, uv);
    double area = 0, seen = 0;
    for (const auto& t : m.cells())
    {
        const auto p = [&](std::size_t k) { return m.points()[static_cast<std::size_t>(t[k])]; };
        area += glm::length(glm::cross(p(1) - p(0), p(2) - p(0))) / 2;
    }
    for (const auto& image : images) seen = std::max(seen, std::abs(image));
    const auto to = [](std::complex<double> wanted, std::complex<double> image)
    { return wanted * std::conj(image) / std::abs(image); };
    const std::complex<double> right = 1, up(0, 1);
    if (!(seen > 0.01 * area)) return to(right, principal_direction(m, uv));
    if (std::abs(images[1]) >= seen / 2) return to(up, images[1]);
    if (std::abs(images[0]) >= seen / 2) return to(right, images[0]);
    return to(up, images[2]);
}

/// Placed map.
struct placed_map
{
    std::vector<vec2> uv;
    double scale = 1; ///< its lengths by those that it had
};

/// Translates a map so that the lower left corner of its box is (0, 0), and scales it so that the longer side is `side`
/// unless that is 0. Of a square, whose sides differ by rounding alone, both are.
inline placed_map in_corner(std::vector<vec2> uv, double side)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    vec2 least(infinity), most(-infinity);
    for (const vec2& p : uv) least = glm::min(least, p), most = glm::max(most, p);
    vec2 sides = most - least;
    const double longer = std::max(sides.x, sides.y);
    if (!(std::min(sides.x, sides.y) > (1 - 1e-14) * longer)) sides = vec2(longer);
    for (vec2& p : uv)
    {
        p -= least;
        if (side > 0) p = p / sides * side; // in this order no coordinate exceeds it
    }
    return {std::move(uv), side > 0 ? side / longer : 1};
}

/// Rotates a map of m upright.
inline std::vector<vec2> turned_up(const mesh<triangle>& m, std::vector<vec2> uv)
{
    const auto turn = upright_turn(m, uv);
    for (vec2& p : uv)
    {
        const auto z = std::complex<double>(p.x, p.y) * turn;
        p = {z.real(), z.imag()};
    }
    return uv;
}

} // namespace taut::impl
