// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_ELEMENTS_HPP
#define TAUT_ELEMENTS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <taut/types.hpp>

/// Elements: what a triangle and a tetrahedron are to the templates of the library.
namespace taut
{

/// Element policy: a triangle of a surface in space, mapped to the plane.
///
///        2
///       / \        facet i is the edge opposite corner i, run so that the triangle lies to its left:
///      1   0       facet 0 = (1, 2), facet 1 = (2, 0), facet 2 = (0, 1)
///     /     \      (the digits on the edges are facet numbers)
///    0---2---1
struct triangle
{
    static constexpr int dimension = 2;
    static constexpr int corners = 3;
    static constexpr bool oriented = true; ///< det S has a sign, which no map may change
    static constexpr std::array<std::array<int, 2>, 3> facets = {{{1, 2}, {2, 0}, {0, 1}}};
    static constexpr double measure_factor = 0.5; ///< area = measure_factor * determinant of two edges
    static constexpr const char *name = "triangle", *names = "triangles";
    static constexpr const char *facet_name = "edge", *facet_names = "edges";

    using rest_corners = std::array<vec3, 3>;   ///< a triangle at rest lives in space
    using mapped_corners = std::array<vec2, 3>; ///< and is mapped to the plane

    /// Twice the signed area in the plane: the determinant of the edges from corner 0.
    static double determinant(const mapped_corners& x)
    {
        const vec2 a = x[1] - x[0], b = x[2] - x[0];
        return a.x * b.y - a.y * b.x;
    }

    /// Edge matrix W of the ideal triangle, upper triangular: corner 0 at the origin, corner 1 on the positive x axis,
    /// corner 2 above it, with the edge lengths of the triangle at rest. It is eq. 7 with 1/lambda = |v1 - v0|, the
    /// choice after eq. 18 that makes det S mapped area / rest area. W[1][1] is 0 for a flat triangle.
    ///
    /// The height comes from the cross product of the two shortest edges. That is exact to about eps / sin(angle),
    /// while lengths alone (see area()) determine the height only to eps / sin(angle)^2: nothing is left of a cap of
    /// height 1e-8.
    static mat2 ideal(const rest_corners& x)
    {
        const vec3 e01 = x[1] - x[0], e12 = x[2] - x[1], e02 = x[2] - x[0];
        const double l01 = length(e01), l12 = length(e12), l02 = length(e02);
        const double double_area = l01 >= l12 && l01 >= l02 ? length(glm::cross(e12, e02))
                                   : l12 >= l02             ? length(glm::cross(e01, e02))
                                                            : length(glm::cross(e01, e12));
        return mat2(l01, 0.0, glm::dot(e01, e02) / l01, double_area / l01);
    }

    /// The same matrix from the three edge lengths alone, for metrics that come without positions.
    /// Domain: positive lengths that satisfy the triangle inequality.
    static mat2 ideal(double l01, double l12, double l20)
    {
        // (l20 - l12)(l20 + l12) instead of the difference of squares keeps the digits of a needle.
        const double along = 0.5 * (l01 + (l20 - l12) / l01 * (l20 + l12));
        return mat2(l01, 0.0, along, 2 * area(l01, l12, l20) / l01);
    }

    /// Area from edge lengths without the cancellation of Heron's formula (Kahan, "Miscalculating area and angles of
    /// a needle-like triangle"). NaN if the lengths violate the triangle inequality.
    static double area(double a, double b, double c)
    {
        if (a < b) std::swap(a, b);
        if (b < c) std::swap(b, c);
        if (a < b) std::swap(a, b);
        // a >= b >= c; the parentheses are the algorithm.
        return 0.25 * std::sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)));
    }

    /// A direction in space, projected to the triangle, as the first axis of a frame, in that of the ideal triangle:
    /// the axes as columns. The identity for a direction across the triangle.
    static mat2 frame(const rest_corners& x, const vec3& direction)
    {
        const vec3 along = glm::normalize(x[1] - x[0]);
        const vec3 across = glm::normalize(glm::cross(glm::cross(along, x[2] - x[0]), along));
        const vec2 axis(glm::dot(direction, along), glm::dot(direction, across));
        const double size = glm::length(axis);
        if (!(size > 1e-6 * length(direction))) return mat2(1.0);
        return mat2(axis.x / size, axis.y / size, -axis.y / size, axis.x / size);
    }

    /// True only for triangles that are far from flat, found without a root or a quotient.
    static bool is_thick(const rest_corners& x)
    {
        const vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[2] - x[1], n = glm::cross(a, b);
        const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
        return glm::dot(n, n) > 1e-16 * longest * longest; // flatness > 1e-8
    }

    /// Smallest height / longest edge of an ideal triangle, in [0, 0.87]; 0 or NaN for a flat one.
    static double flatness(const mat2& W)
    {
        const vec2 a = W[0], b = W[1], c = b - a;
        return W[0][0] * W[1][1] / std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    }

private:
    static double length(const vec3& v) { return std::sqrt(glm::dot(v, v)); }
};

/// Element policy: a tetrahedron, mapped from space to space.
///
///        3
///       /|\        positive when corner 3 sees 0, 1, 2 turn counter-clockwise:
///      / | \       det [x1 - x0, x2 - x0, x3 - x0] > 0.
///     0--|--2      Facet i is the face opposite corner i, its normal pointing out.
///      \ | /
///        1
struct tetrahedron
{
    static constexpr int dimension = 3;
    static constexpr int corners = 4;
    static constexpr bool oriented = true; ///< det S has a sign, which no map may change
    static constexpr std::array<std::array<int, 3>, 4> facets = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    static constexpr double measure_factor = 1.0 / 6.0; ///< volume = measure_factor * determinant of three edges
    static constexpr const char *name = "tetrahedron", *names = "tetrahedra";
    static constexpr const char *facet_name = "face", *facet_names = "faces";

    using rest_corners = std::array<vec3, 4>;
    using mapped_corners = std::array<vec3, 4>;

    /// Six times the signed volume: the determinant of the edges from corner 0.
    static double determinant(const mapped_corners& x)
    {
        return glm::dot(glm::cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]);
    }

    /// Edge matrix W of the ideal tetrahedron, upper triangular: corner 0 at the origin, corner 1 on the x axis,
    /// corner 2 in the xy plane, with the edge lengths of the tetrahedron at rest, so that det S is mapped volume /
    /// rest volume (eqs. 1-3, 18). W[2][2] has the sign of the volume.
    static mat3 ideal(const rest_corners& x);

    /// A direction in space as the first axis of a frame, in that of the ideal tetrahedron: the axes as columns. The
    /// other two lie somewhere across it.
    static mat3 frame(const rest_corners& x, const vec3& direction);

    /// True only for tetrahedra that are far from flat and not inverted, found without a root or a quotient.
    static bool is_thick(const rest_corners& x)
    {
        double longest = 0;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, glm::dot(x[i] - x[j], x[i] - x[j]));
        const double volume = determinant(x);
        return volume > 0 && volume * volume > 1e-12 * longest * longest * longest; // flatness > 1e-6
    }

    /// Smallest height / longest edge of an ideal tetrahedron, with the sign of the volume; 0 or NaN for a flat one.
    static double flatness(const mat3& W);

private:
    static double length(const vec3& v) { return std::sqrt(glm::dot(v, v)); }
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
