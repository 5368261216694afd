// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <taut/impl/core/hierarchy/flat_star.hpp>
#include <taut/impl/core/hierarchy/rings.hpp>

namespace taut::impl
{

/// Surface under decimation.
struct thinning_surface
{
    std::vector<vec3> points;
    ring_table rings;
    std::vector<char> open; ///< on the boundary
    std::vector<char> keep; ///< never removed
};

/// Conditions of a collapse. Strict at first, relaxed when too few vertices qualify.
struct collapse_rules
{
    double quality;         ///< least quality of a new triangle, unless the star has a worse one already; 0 to 1
    double largest_size;    ///< of a star's area, relative to the mean
    double sharpest_corner; ///< of the boundary, in half turns: sharper corners stay
    bool may_fold;          ///< new triangles may face away from the star's normal
};

/// Shape of a triangle, 1 if equilateral: 4 sqrt(3) area / sum of squared edge lengths.
inline double triangle_quality(double double_area, double squared_lengths)
{
    return 2 * std::numbers::sqrt3 * double_area / squared_lengths;
}

/// Worst triangle of the star.
inline double star_quality(const flat_star& s)
{
    double worst = 1;
    for (std::size_t i = 0; i < s.triangles(); ++i)
    {
        const vec3 a = s.spoke[i], b = s.spoke[s.next(i)], c = b - a;
        worst = std::min(
            worst, triangle_quality(glm::length(glm::cross(a, b)), glm::dot(a, a) + glm::dot(b, b) + glm::dot(c, c)));
    }
    return worst;
}

/// Worst triangle if the star's polygon is triangulated from corner t: by shape in the plane and in space, less for a
/// normal that turns away. 0 if it is not above `enough`.
double fan_quality(const flat_star& s, std::size_t t, double normal_length, double enough, bool may_fold);

/// True if pulling v into ring[t] would make an edge or a triangle that exists already (the link condition), or a
/// triangle of three kept vertices, which no solver could repair.
bool breaks_surface(const thinning_surface& m, std::span<const idx> ring, bool open, std::size_t t);

/// Finds the best target of a half-edge collapse of v, as a position in its ring, or -1. Boundary vertices are
/// collapsed along the boundary only.
int choose_target(const thinning_surface& m, idx v, const flat_star& s, const collapse_rules& rules);

} // namespace taut::impl
