// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Wishes for the places of seams: they make lengths count more or less. The bounds of distortion hold all the same.
struct seam_wishes
{
    /// How much seams avoid what is seen from outside, 0 to 1: 0.5 counts a length in a deep hollow about half, 1 next
    /// to nothing. Occlusion is computed by rays from each vertex.
    double hide = 0;

    /// Edges that are bent by more than this, in degrees from 0 to 180, count a quarter, and concave ones an eighth;
    /// 180: none.
    double crease_angle = 180;

    /// Factors of the lengths of edges: one number per side of the surface, the same on both sides of an edge, from
    /// 0.001 to 1000; or empty.
    std::span<const double> weights = {};

    bool any() const { return hide > 0 || crease_angle < 180 || !weights.empty(); }

    /// Throws parameter_error. sides: of the surface
    void validate(std::size_t sides) const
    {
        if (!(hide >= 0 && hide <= 1)) throw parameter_error("hide_seams", "must be 0 to 1");
        if (!(crease_angle >= 0 && crease_angle <= 180)) throw parameter_error("crease_angle", "must be 0 to 180");
        if (!weights.empty() && weights.size() != sides)
            throw parameter_error("weights", "empty or one number per side of the surface");
        for (const double w : weights)
            if (!(w >= 1e-3 && w <= 1e3)) throw parameter_error("weights", "must be 0.001 to 1000");
    }
};

/// What a unit of length of a seam counts along each side by these wishes: one number per side, the same on both.
/// open: vertex_openness(), if wishes.hide is above 0
inline std::vector<double> seam_factors(const mesh<triangle>& m, const facet_table& f, const seam_wishes& wishes,
                                        std::span<const double> open)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<double> factors(f.twin.size(), 1);
    const double bent = std::cos(wishes.crease_angle * std::numbers::pi / 180);
    parallel_for(factors.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t s = begin; s < end; ++s)
                     {
                         double& factor = factors[s];
                         const auto [a, b] = side_vertices(m, static_cast<idx>(s));
                         if (wishes.hide > 0)
                         {
                             const double seen = 0.5 * (open[u(a)] + open[u(b)]);
                             factor = 1 - wishes.hide * (1 - std::max(0.01, seen * seen));
                         }
                         if (!wishes.weights.empty()) factor *= wishes.weights[s];
                         const idx t = f.twin[s];
                         if (wishes.crease_angle >= 180 || t < 0) continue;
                         const auto x = m.rest(static_cast<idx>(s / 3)), y = m.rest(t / 3);
                         const vec3 n = glm::cross(x[1] - x[0], x[2] - x[0]), o = glm::cross(y[1] - y[0], y[2] - y[0]);
                         const double size = glm::length(n) * glm::length(o);
                         if (!(size > 0) || glm::dot(n, o) >= bent * size) continue;
                         const bool concave = glm::dot(n, y[u(t % 3)] - m.points()[u(a)]) > 0;
                         factor *= concave ? 0.125 : 0.25;
                     }
                 });
    for (double& x : factors) x = std::clamp(x, 1e-3, 1e3);
    return factors;
}

/// Cost of a seam along each side: the length of the edge, less along creases, where it is hardly visible. The same
/// on both sides of an edge. factors: of that, one a side, or empty
inline std::vector<double> seam_weights(const mesh<triangle>& m, const facet_table& f,
                                        std::span<const double> factors = {})
{
    constexpr double least = 0.1; // of the length, where an edge is as sharp as a cube's
    std::vector<vec3> normals(m.cells().size());
    std::vector<double> weights(f.twin.size());
    parallel_for(normals.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         const auto x = m.rest(static_cast<idx>(c));
                         const vec3 n = glm::cross(x[1] - x[0], x[2] - x[0]);
                         const double length = glm::length(n);
                         normals[c] = length > 0 ? n / length : vec3(0.0);
                     }
                 });
    parallel_for(weights.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t s = begin; s < end; ++s)
                     {
                         const auto side = side_vertices(m, static_cast<idx>(s));
                         const double length = glm::distance(m.points()[static_cast<std::size_t>(side[0])],
                                                             m.points()[static_cast<std::size_t>(side[1])]);
                         const auto t = static_cast<std::size_t>(std::max(f.twin[s], 0)) / 3;
                         const double cosine = f.twin[s] < 0 ? 1 : std::max(0.0, glm::dot(normals[s / 3], normals[t]));
                         weights[s] =
                             length * (least + (1 - least) * cosine * cosine) * (factors.empty() ? 1 : factors[s]);
                     }
                 });
    return weights;
}

} // namespace taut::impl
