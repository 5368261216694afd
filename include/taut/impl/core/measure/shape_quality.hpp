// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/mesh.hpp>
#include <taut/quality.hpp>

namespace taut::impl
{

/// a / b; 0 for an element whose corners are all in one place
inline double share(double a, double b)
{
    return b > 0 ? a / b : 0;
}

/// The corners times a power of two, so that edges are about 1 long: shapes have no size, products of lengths have.
template <class Point, std::size_t N>
std::array<Point, N> of_unit_size(std::array<Point, N> x)
{
    double most = 0;
    for (const Point& p : x)
        for (int k = 0; k < Point::length(); ++k) most = std::max(most, std::abs(p[k] - x[0][k]));
    if (!(most > 0) || !std::isfinite(most)) return x;
    const int exponent = -std::ilogb(most);
    for (Point& p : x)
        for (int k = 0; k < Point::length(); ++k) p[k] = std::ldexp(p[k], exponent);
    return x;
}

inline element_shape shape_of(const std::array<vec2, 3>& corners)
{
    const auto x = impl::of_unit_size(corners);
    const std::array<vec2, 3> edge = {x[2] - x[1], x[0] - x[2], x[1] - x[0]}; // opposite of each corner
    std::array<double, 3> length;
    for (std::size_t k = 0; k < 3; ++k) length[k] = glm::length(edge[k]);
    const double det = edge[2].x * -edge[1].y + edge[2].y * edge[1].x;
    element_shape s{.min_angle = 180};
    s.mean_ratio = impl::share(2 * std::numbers::sqrt3 * det,
                               length[0] * length[0] + length[1] * length[1] + length[2] * length[2]);
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const vec2 a = edge[(k + 2) % 3], b = -edge[(k + 1) % 3];
        const double angle = std::atan2(std::abs(det), glm::dot(a, b)) * 180 / std::numbers::pi;
        s.min_angle = std::min(s.min_angle, angle);
        s.max_angle = std::max(s.max_angle, angle);
        largest = std::max(largest, length[(k + 1) % 3] * length[(k + 2) % 3]);
    }
    s.scaled_jacobian = impl::share(2 / std::numbers::sqrt3 * det, largest);
    return s;
}

inline element_shape shape_of(const std::array<vec3, 4>& corners)
{
    const auto x = impl::of_unit_size(corners);
    const double det = tetrahedron::determinant(x);
    std::array<std::array<double, 4>, 4> length{};
    double squares = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j)
        {
            const vec3 e = x[i] - x[j];
            squares += glm::dot(e, e);
            length[i][j] = length[j][i] = glm::length(e);
        }
    element_shape s{.min_angle = 180};
    s.mean_ratio = impl::share(std::copysign(12 * std::cbrt(det * det / 4), det), squares); // 3 V = det / 2
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i)
        largest = std::max(largest, length[i][(i + 1) % 4] * length[i][(i + 2) % 4] * length[i][(i + 3) % 4]);
    s.scaled_jacobian = impl::share(std::numbers::sqrt2 * det, largest);
    std::array<vec3, 4> normal; // of the faces
    for (std::size_t f = 0; f < 4; ++f)
    {
        const auto& side = tetrahedron::facets[f];
        const auto corner = [&](std::size_t k) { return x[static_cast<std::size_t>(side[k])]; };
        normal[f] = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    }
    for (std::size_t f = 0; f < 4; ++f)
        for (std::size_t g = 0; g < f; ++g)
        {
            const double angle =
                std::atan2(glm::length(glm::cross(normal[f], normal[g])), -glm::dot(normal[f], normal[g])) * 180 /
                std::numbers::pi;
            s.min_angle = std::min(s.min_angle, angle);
            s.max_angle = std::max(s.max_angle, angle);
        }
    return s;
}

/// The corner of a cell of another kind, by the simplex that its edges span. W: its edge matrix where the cell is
/// regular. The mean ratio is D det S^(2/D) / |S|^2 with S = A W^-1, the angles are those of the cell at this corner.
inline element_shape corner_shape(const std::array<vec2, 3>& corners, const mat2& W)
{
    const auto x = impl::of_unit_size(corners);
    const vec2 a = x[1] - x[0], b = x[2] - x[0];
    const double det = a.x * b.y - a.y * b.x, edges = glm::length(a) * glm::length(b);
    const mat2 S = mat2(a, b) * glm::inverse(W);
    const double angle = std::atan2(std::abs(det), glm::dot(a, b)) * 180 / std::numbers::pi;
    return {impl::share(2 * glm::determinant(S), glm::dot(S[0], S[0]) + glm::dot(S[1], S[1])),
            impl::share(det, edges * glm::determinant(W) / (glm::length(W[0]) * glm::length(W[1]))), angle, angle};
}

inline element_shape corner_shape(const std::array<vec3, 4>& corners, const mat3& W)
{
    const auto x = impl::of_unit_size(corners);
    const std::array<vec3, 3> edge = {x[1] - x[0], x[2] - x[0], x[3] - x[0]};
    const mat3 S = mat3(edge[0], edge[1], edge[2]) * glm::inverse(W);
    double squares = 0, edges = 1, wanted = glm::determinant(W);
    element_shape s{.min_angle = 180};
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto column = static_cast<int>(k);
        squares += glm::dot(S[column], S[column]);
        edges *= glm::length(edge[k]);
        wanted /= glm::length(W[column]);
        // Of the two sides at an edge.
        const vec3 a = glm::cross(edge[k], edge[(k + 1) % 3]), b = glm::cross(edge[k], edge[(k + 2) % 3]);
        const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
        s.min_angle = std::min(s.min_angle, angle);
        s.max_angle = std::max(s.max_angle, angle);
    }
    const double det = glm::determinant(S);
    s.mean_ratio = impl::share(std::copysign(3 * std::cbrt(det * det), det), squares);
    s.scaled_jacobian = impl::share(tetrahedron::determinant(x), edges * wanted);
    return s;
}

/// shape(c, corners) of each cell.
template <class Element, class Shape>
std::vector<element_shape> shapes_of(const std::vector<typename mesh<Element>::cell>& cells,
                                     std::span<const vec<Element::dimension>> x, const Shape& shape)
{
    std::vector<element_shape> shapes(cells.size());
    parallel_for(cells.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         typename Element::mapped_corners corners;
                         for (std::size_t k = 0; k < corners.size(); ++k)
                             corners[k] = x[static_cast<std::size_t>(cells[c][k])];
                         shapes[c] = shape(c, corners);
                     }
                 });
    return shapes;
}

} // namespace taut::impl
