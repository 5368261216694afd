// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <taut/impl/core/types.hpp>

namespace taut
{

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

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/mesh/tetrahedron.ipp>
#endif
