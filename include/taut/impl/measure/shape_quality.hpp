// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/parallel.hpp>
#include <taut/impl/mesh/mesh.hpp>

namespace taut::impl
{

/// Shape qualities of a triangle or tetrahedron, the measures of mesh generation: 1 is regular, 0 flat, less inverted.
/// Definitions as in Stimpson et al., "The Verdict library reference manual" (2007), the mean ratio as in Liu and Joe,
/// "Relationship between tetrahedron shape measures" (1994).
struct element_shape
{
    double mean_ratio = 0; ///< D = 2: 4 sqrt(3) area / sum l^2; D = 3: 12 (3 volume)^(2/3) / sum l^2, with its sign
    double scaled_jacobian = 0; ///< the smallest over the corners of det / product of the edges there, scaled to 1
    double min_angle = 0;       ///< degrees; corner angles of triangles, dihedral ones of tetrahedra, 0 to 180
    double max_angle = 0;

    /// Takes the worse value of each measure.
    void join(const element_shape& other)
    {
        mean_ratio = std::min(mean_ratio, other.mean_ratio);
        scaled_jacobian = std::min(scaled_jacobian, other.scaled_jacobian);
        min_angle = std::min(min_angle, other.min_angle);
        max_angle = std::max(max_angle, other.max_angle);
    }
};

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

/// Shape qualities of the elements of a mesh.
struct shape_quality
{
    impl::element_shape worst{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 180, 0};
    double mean_ratio = 0, scaled_jacobian = 0; ///< means over the elements
    std::vector<idx> worst_ids;                 ///< up to ten with the smallest mean ratios, the worst first

    /// ids: the number of each element; empty: they count from 0
    explicit shape_quality(std::span<const impl::element_shape> shapes = {}, std::span<const idx> ids = {})
    {
        std::vector<std::pair<double, idx>> ranked;
        for (std::size_t c = 0; c < shapes.size(); ++c)
        {
            const impl::element_shape& s = shapes[c];
            worst.join(s);
            mean_ratio += s.mean_ratio / static_cast<double>(shapes.size());
            scaled_jacobian += s.scaled_jacobian / static_cast<double>(shapes.size());
            ranked.emplace_back(s.mean_ratio, ids.empty() ? static_cast<idx>(c) : ids[c]);
        }
        const auto shown = static_cast<std::ptrdiff_t>(std::min<std::size_t>(10, ranked.size()));
        std::partial_sort(ranked.begin(), ranked.begin() + shown, ranked.end());
        for (std::ptrdiff_t i = 0; i < shown; ++i) worst_ids.push_back(ranked[static_cast<std::size_t>(i)].second);
    }
};

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

namespace taut
{

/// Measures the shapes of all elements of a mesh. x: one finite position per vertex.
template <class Element>
impl::shape_quality measure_shapes(const std::vector<typename mesh<Element>::cell>& cells,
                                   std::span<const vec<Element::dimension>> x)
{
    return impl::shape_quality(
        impl::shapes_of<Element>(cells, x, [](std::size_t, const auto& corners) { return impl::shape_of(corners); }));
}

/// Measures cells of any kind by the simplices at their corners: the quality of a cell is that of its worst corner.
/// owners: the cell of each simplex, those of one together; one alone is the cell itself. regular: as for
/// corner_shape().
template <class Element>
impl::shape_quality measure_shapes(const std::vector<typename mesh<Element>::cell>& simplices,
                                   std::span<const vec<Element::dimension>> x, std::span<const idx> owners,
                                   std::span<const mat<Element::dimension>> regular)
{
    const auto alone = [&](std::size_t c)
    { return (c == 0 || owners[c - 1] != owners[c]) && (c + 1 == owners.size() || owners[c + 1] != owners[c]); };
    const auto corners =
        impl::shapes_of<Element>(simplices, x,
                                 [&](std::size_t c, const auto& corner) {
                                     return alone(c) ? impl::shape_of(corner) : impl::corner_shape(corner, regular[c]);
                                 });
    std::vector<impl::element_shape> shapes;
    std::vector<idx> ids;
    for (std::size_t c = 0; c < corners.size(); ++c)
        if (c > 0 && owners[c] == owners[c - 1])
            shapes.back().join(corners[c]);
        else
        {
            shapes.push_back(corners[c]);
            ids.push_back(owners[c]);
        }
    return impl::shape_quality(shapes, ids);
}

} // namespace taut
