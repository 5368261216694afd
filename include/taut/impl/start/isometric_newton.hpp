// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/energy/corner_derivatives.hpp>
#include <taut/impl/energy/isometric.hpp>
#include <taut/impl/energy/modes.hpp>
#include <taut/impl/hierarchy/star_region.hpp>
#include <taut/impl/mesh/first_flip.hpp>
#include <taut/impl/mesh/ideal.hpp>
#include <taut/impl/sparse/front_cholesky.hpp>

namespace taut::impl
{

/// energy::isometric of a small surface, summed over triangles by area, and Newton's method on it with the Hessian of
/// each triangle projected to positive semi-definite and a direct solver.
class isometric_newton
{
public:
    /// fixed: one flag a vertex; these are not moved. weights: one a triangle instead of its area, or none. All of it
    /// in one unit of length. The cells are referred to.
    isometric_newton(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells,
                     std::span<const char> fixed, std::span<const double> weights = {})
        : cells_(cells), solver_(cells, fixed), blocks_(cells.size())
    {
        for (const auto& t : cells)
        {
            const mat2 W = stiff_ideal(points[u(t[1])] - points[u(t[0])], points[u(t[2])] - points[u(t[0])]);
            inverse_.push_back(invert_upper(W));
            area_.push_back(weights.empty() ? 0.5 * W[0][0] * W[1][1] : weights[inverse_.size() - 1]);
            total_ += area_.back();
        }
    }

    /// Area mean; +infinity if a triangle is not surely positive.
    double value(std::span<const vec2> x) const
    {
        double sum = 0;
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            const auto& t = cells_[c];
            if (!surely_positive(x[u(t[0])], x[u(t[1])], x[u(t[2])])) return std::numeric_limits<double>::infinity();
            const mat2 S = mapped(x, c);
            sum += area_[c] * energy::isometric{}(element<double, 2>{S, glm::determinant(S), area_[c]});
        }
        return sum / total_;
    }

    /// One step from x with decrease; returns the new value, or the old one if no step decreases it.
    double step(std::vector<vec2>& x, double here)
    {
        std::vector<vec2> force(x.size(), vec2(0.0));
        for (std::size_t c = 0; c < cells_.size(); ++c) derivatives(x, c, force);
        solver_.factorize(blocks_, 1e-12);
        const std::vector<vec2> d = solver_.solve(force);
        double slope = 0;
        for (std::size_t v = 0; v < x.size(); ++v) slope -= glm::dot(force[v], d[v]);
        slope /= total_;
        if (!(slope < 0)) return here;

        double longest = 1 / 0.9;
        for (std::size_t c = 0; c < cells_.size(); ++c)
            longest = std::min(longest, first_flip(mapped(x, c), mapped(d, c)));
        std::vector<vec2> trial(x.size());
        double t = 0.9 * longest;
        for (int halving = 0; halving < 40; ++halving, t /= 2)
        {
            for (std::size_t v = 0; v < x.size(); ++v) trial[v] = x[v] + t * d[v];
            if (const double there = value(trial); there <= here + 1e-4 * t * slope)
            {
                x = std::move(trial);
                return there;
            }
        }
        return here;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    mat2 mapped(std::span<const vec2> x, std::size_t c) const { return shape_matrix<2>(cells_[c], x, inverse_[c]); }

    /// Sets the triangle's block and adds its negative gradient.
    void derivatives(std::span<const vec2> x, std::size_t c, std::vector<vec2>& force)
    {
        const mat2 S = mapped(x, c);
        const auto psi = energy::isometric::derivatives(norm2(S), glm::determinant(S));
        blocks_[c] = corner_hessian<2>(plane_modes<double>(S, psi, {}).hessian(area_[c]), inverse_[c]);
        const auto g = corner_gradient<2>(area_[c] * gradient_by_shape(S, psi.by_I, psi.by_d), inverse_[c]);
        for (std::size_t k = 0; k < 3; ++k) force[u(cells_[c][k])] -= g[k];
    }

    std::span<const std::array<idx, 3>> cells_;
    std::vector<mat2> inverse_;
    std::vector<double> area_;
    double total_ = 0;
    front_cholesky solver_;
    std::vector<front_cholesky::block> blocks_;
};

} // namespace taut::impl
