// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include <taut/impl/core/types.hpp>

namespace taut
{

/// Element policy: two triangles of a surface at their common edge, mapped from space to space.
///
///        2
///       / \        the triangles are (0, 1, 2) and (1, 0, 3), oriented alike
///      0---1
///       \ /
///        3
///
/// It has the corners of a tetrahedron, which is flat where the surface is: it has no orientation that a map could
/// invert, and its ideal is no rest shape but a length. The rest shape is given by attributes of cells
/// (thin_shell.hpp).
struct hinge
{
    static constexpr int dimension = 3;
    static constexpr int corners = 4;
    static constexpr bool oriented = false;
    static constexpr double measure_factor = 1.0 / 6.0;
    static constexpr const char *name = "hinge", *names = "hinges";

    static constexpr const char *facet_name = "triangle", *facet_names = "triangles";

    using rest_corners = std::array<vec3, 4>;
    using mapped_corners = std::array<vec3, 4>;

    /// The identity times the length of the common edge: S = A W^-1 has the edges from corner 0 as columns.
    static mat3 ideal(const rest_corners& x) { return mat3(std::sqrt(glm::dot(x[1] - x[0], x[1] - x[0]))); }

    /// Directions mean nothing to it.
    static mat3 frame(const rest_corners&, const vec3&) { return mat3(1.0); }

    static bool is_thick(const rest_corners& x) { return glm::dot(x[1] - x[0], x[1] - x[0]) > 0; }

    /// 1 where there is a common edge.
    static double flatness(const mat3& W) { return W[0][0] > 0 ? 1 : 0; }
};

} // namespace taut
