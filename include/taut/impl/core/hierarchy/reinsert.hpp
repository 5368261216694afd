// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/core/block_sum.hpp>
#include <taut/impl/core/hierarchy/hierarchy.hpp>
#include <taut/impl/core/hierarchy/star_energy.hpp>

namespace taut::impl
{

/// Parameters of the reinsertion of removed vertices into a map.
struct reinsert_params
{
    int newton_steps =
        10; ///< local steps on the isometric energy of the star of each vertex, at most; 0 to 50. Most need two
    unsigned threads = 0; ///< at most so many; 0: as many as the machine runs at once. The result does not change

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (newton_steps < 0 || newton_steps > 50) throw parameter_error("newton_steps", "must be 0 to 50");
    }
};

/// Map of a level, from one of the next coarser level.
struct reinsertion
{
    std::vector<vec2> uv;
    /// Vertices of the level, ascending, for which no position was found that keeps all triangles around them
    /// positive. Empty if no triangle of the coarse map is flipped or flat but for rounding.
    std::vector<idx> failed;
};

/// Mean value coordinates of the vertex in its ring at rest, applied to the ring's image (Floater 2003).
inline vec2 mean_value_point(const ring_image& ring, std::span<const vec3> rest)
{
    // tan of half the angle between neighbours i and i + 1.
    std::array<double, largest_star> half_tan;
    std::array<double, largest_star> radius;
    for (std::size_t i = 0; i < ring.size; ++i) radius[i] = glm::length(rest[i]);
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        const std::size_t j = ring.next(i);
        const double sum = radius[i] * radius[j] + glm::dot(rest[i], rest[j]);
        half_tan[i] = std::min(glm::length(glm::cross(rest[i], rest[j])) / std::max(sum, 1e-300), 20.0);
    }
    vec2 p(0.0);
    double total = 0;
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        const double w = (half_tan[i] + half_tan[i > 0 ? i - 1 : ring.size - 1]) / std::max(radius[i], 1e-300);
        p += w * ring.corner[i];
        total += w;
    }
    return p / total;
}

/// Position of a boundary vertex relative to its two neighbours along the boundary with its star unfolded to the plane,
/// in the frame of their images.
inline vec2 boundary_point(const ring_image& ring, std::span<const vec3> rest)
{
    double angle = 0;
    for (std::size_t i = 0; i + 1 < ring.size; ++i)
        angle += std::atan2(glm::length(glm::cross(rest[i], rest[i + 1])), glm::dot(rest[i], rest[i + 1]));
    angle = std::min(angle, 1.6 * std::numbers::pi); // as in flatten()
    // The vertex at 0, its neighbours at a and b: 0 = a + z (b - a) with a complex z.
    const vec2 a(glm::length(rest[0]), 0);
    const vec2 b = glm::length(rest[ring.size - 1]) * vec2(std::cos(angle), std::sin(angle));
    const vec2 e = b - a;
    const vec2 z = -vec2(glm::dot(a, e), cross(e, a)) / glm::dot(e, e);
    const vec2 origin = ring.corner[0], along = ring.corner[ring.size - 1] - origin;
    return origin + z.x * along + z.y * vec2(-along.y, along.x);
}

/// Places one removed vertex. Returns false if no position is certain to be valid.
bool place(const removals<triangle>& removed, std::size_t r, std::span<const idx> numbers, std::span<const vec3> points,
           int newton_steps, std::span<vec2> uv);

/// Reinserts the vertices between levels `level` and `level` + 1 into a map of the coarser one, round by round. A
/// coarse map without flipped triangles gives a fine one without, exactly; vertices that cannot be placed so are
/// reported. Vertices of the coarse level keep their positions bit for bit.
///
/// points: rest positions of the vertices of the finest level, in this or another frame
/// coarse: one image per vertex of level + 1
///
/// Throws parameter_error if an argument has the wrong size.
reinsertion reinsert(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points,
                     std::span<const vec2> coarse, const reinsert_params& params = {});

/// Scale that minimises the isometric energy of a map of a level: (b / a)^(1/4) with a = sum of area |S|^2 and b = sum
/// of area |S|^2 / det^2 over the cells. 1 if that is not finite and positive. Meant for maps without pins.
inline double isometric_scale(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points,
                              std::span<const vec2> uv, unsigned threads = 0)
{
    struct sums
    {
        double plain = 0, inverse = 0;
        sums& operator+=(const sums& o)
        {
            plain += o.plain;
            inverse += o.inverse;
            return *this;
        }
    };
    const auto& numbers = h.levels[level].vertices;
    const auto& cells = h.levels[level].cells;
    const auto add = [&](sums& sum, std::size_t c)
    {
        const auto& t = cells[c];
        triangle::rest_corners rest;
        for (std::size_t k = 0; k < 3; ++k)
            rest[k] = points[static_cast<std::size_t>(numbers[static_cast<std::size_t>(t[k])])];
        const mat2 W = triangle::ideal(rest);
        if (!(W[1][1] > 0)) return; // flat at rest: no area
        const mat2 S = shape_matrix<2>(t, uv, impl::invert_upper(W));
        const double det = glm::determinant(S);
        const double n = 0.5 * W[0][0] * W[1][1] * norm2(S);
        sum.plain += n;
        sum.inverse += n / (det * det);
    };
    const auto sum = impl::block_sum<sums>(cells.size(), add, threads);
    const double scale = std::pow(sum.inverse / sum.plain, 0.25);
    return std::isfinite(scale) && scale > 0 ? scale : 1.0;
}

} // namespace taut::impl
