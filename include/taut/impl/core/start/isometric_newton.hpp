// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/energies.hpp>
#include <taut/impl/core/hierarchy/star_region.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/objective/plane_newton.hpp>

namespace taut::impl
{

/// Newton's method on the area mean of energy::isometric of a small surface.
class isometric_newton
{
public:
    /// fixed: one flag a vertex; these are not moved. weights: one a triangle instead of its area, or none. All of it
    /// in one unit of length. The cells are referred to.
    isometric_newton(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells,
                     std::span<const char> fixed, std::span<const double> weights = {})
        : held_(marks(fixed)), shapes_(shapes(points, cells, weights)), newton_(cells, shapes_, held_)
    {
    }
    /// The same of given shapes; weights are those of all.
    isometric_newton(std::span<const std::array<idx, 3>> cells, std::vector<target_shape<2>> shapes,
                     fixed_marks<2> held)
        : held_(std::move(held)), shapes_(relative(std::move(shapes))), newton_(cells, shapes_, held_)
    {
    }
    isometric_newton(const isometric_newton&) = delete;
    isometric_newton& operator=(const isometric_newton&) = delete;

    /// Area mean, and springs; +infinity if a triangle is not surely positive.
    double value(std::span<const vec2> x, std::span<const directed_spring<2>> springs = {}) const
    {
        return newton_.value(x, {}, springs);
    }

    /// One step from x with decrease; returns the new value, or the old one if no step decreases it.
    double step(std::vector<vec2>& x, double here, std::span<const directed_spring<2>> springs = {})
    {
        return newton_.step(x, here, {}, springs);
    }

private:
    /// Isometric energy as a term of plane_newton.
    struct term
    {
        bool barrier() const { return true; }
        double value(const std::array<vec2, 3>& x, const mat2& S) const
        {
            if (!surely_positive(x[0], x[1], x[2])) return std::numeric_limits<double>::infinity();
            return energy::isometric{}(element<double, 2>{S, glm::determinant(S), 1});
        }
        auto derivatives(double I, double d) const { return energy::isometric::derivatives(I, d); }
    };

    static fixed_marks<2> marks(std::span<const char> fixed)
    {
        fixed_marks<2> held(fixed.size());
        for (std::size_t v = 0; v < fixed.size(); ++v) held[v] = fixed[v] ? fixed_marks<2>::every : 0;
        return held;
    }

    static std::vector<target_shape<2>> shapes(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells,
                                               std::span<const double> weights)
    {
        std::vector<target_shape<2>> all;
        for (const auto& t : cells)
        {
            const vec3& first = points[static_cast<std::size_t>(t[0])];
            const mat2 W = stiff_ideal(points[static_cast<std::size_t>(t[1])] - first,
                                       points[static_cast<std::size_t>(t[2])] - first);
            all.push_back({invert_upper(W), weights.empty() ? 0.5 * W[0][0] * W[1][1] : weights[all.size()]});
        }
        return relative(std::move(all));
    }

    static std::vector<target_shape<2>> relative(std::vector<target_shape<2>> all)
    {
        double total = 0;
        for (const auto& s : all) total += s.weight;
        for (auto& s : all) s.weight /= total;
        return all;
    }

    fixed_marks<2> held_;
    std::vector<target_shape<2>> shapes_;
    plane_newton<term> newton_;
};

} // namespace taut::impl
