// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// One iteration of the topological operators (paper, Algorithm 2, lines 3 to 7), on the host and in double: the
/// reference for the kernels of untangle_operator.
///
/// Vertices of elements with det <= margin move along the gradient of +det, which is what the right sides of eqs. 23
/// and 24 are, and away from shear (Fig. 10). The sum is over those elements alone: over all elements around an inner
/// vertex the gradients cancel.
template <class Element>
struct operator_step
{
    static constexpr int D = Element::dimension;
    static constexpr std::size_t N = Element::corners;
    using corner_points = std::array<vec<D>, N>;

    double delta = 0.5;
    double beta = 0.1; ///< same units as det, as is the margin
    double shear = 1;
    double margin = 0;

    /// The map after the move.
    std::vector<vec<D>> operator()(const mesh<Element>& m, const std::vector<vec<D>>& x,
                                   const fixed_marks<D>& held) const
    {
        std::vector<vec<D>> sum(x.size(), vec<D>(0.0));
        for (const auto& cell : m.cells())
        {
            corner_points p;
            for (std::size_t k = 0; k < N; ++k) p[k] = x[static_cast<std::size_t>(cell[k])];
            const double det = Element::determinant(p);
            if (det > margin) continue;
            const double factor = shear * std::max(1 - std::abs(det) / beta, 0.0); // eq. 26
            for (std::size_t k = 0; k < N; ++k) sum[static_cast<std::size_t>(cell[k])] += direction(p, k, factor);
        }
        std::vector<vec<D>> moved = x;
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int c = 0; c < D; ++c)
                if (!held.test(v, c)) moved[v][c] += delta * sum[v][c];
        return moved;
    }

    /// The sum of margin - det over the elements that would move. It is the objective (eq. 22); and where the boundary
    /// is fixed, sum |det| of Algorithm 2 is twice this plus a constant, of which single precision would see nothing
    /// else.
    double value(const mesh<Element>& m, const std::vector<vec<D>>& x) const
    {
        double sum = 0;
        for (const auto& cell : m.cells())
        {
            corner_points p;
            for (std::size_t k = 0; k < N; ++k) p[k] = x[static_cast<std::size_t>(cell[k])];
            sum += std::max(margin - Element::determinant(p), 0.0);
        }
        return sum;
    }

    /// Direction of corner k: the gradient of det and, if the foot of the corner is outside of the opposite facet,
    /// `factor` times a vector of the same length along the facet, towards its middle. In space both are brought to a
    /// fifth of the square root of their length: a length again and not an area, or large elements overshoot and the
    /// map blows up; and a vertex has some five times as many elements as in the plane.
    static vec<D> direction(const corner_points& x, std::size_t k, double factor)
    {
        const auto at = [&](std::size_t i) { return x[static_cast<std::size_t>(Element::facets[k][i])]; };
        if constexpr (D == 2)
        {
            const vec2 e = at(1) - at(0);
            const double along = glm::dot(x[k] - at(0), e) < 0 ? factor : glm::dot(x[k] - at(1), e) > 0 ? -factor : 0.0;
            return vec2(-e.y, e.x) + along * e;
        }
        else
        {
            const vec3 u = at(0) - x[k], v = at(1) - x[k], w = at(2) - x[k];
            const vec3 uv = glm::cross(u, v), vw = glm::cross(v, w), wu = glm::cross(w, u);
            const vec3 normal = uv + vw + wu; // out of the element, twice as long as the facet is large
            const double squared = std::max(glm::dot(normal, normal), std::numeric_limits<double>::min());
            const double shorter = 0.2 / std::sqrt(std::sqrt(squared));
            // Barycentric coordinates of the foot, but for a positive factor.
            const double least = std::min({glm::dot(normal, uv), glm::dot(normal, vw), glm::dot(normal, wu)});
            if (!(least < 0)) return -shorter * normal;
            const vec3 middle = u + v + w;
            const vec3 along = middle - glm::dot(middle, normal) / squared * normal;
            const double length = std::max(glm::length(along), std::numeric_limits<double>::min());
            return shorter * (factor * std::sqrt(squared) / length * along - normal);
        }
    }
};

} // namespace taut::impl
