// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/types.hpp>

namespace taut::impl
{

/// Positions in a list of points and their weights, which sum to 1; unused places repeat a used one with weight 0.
struct affine_weights
{
    std::array<std::size_t, 4> at{};
    std::array<double, 4> weights{1, 0, 0, 0};
};

/// Search for the affine combination of at most four points that best represents the origin.
class affine_search
{
public:
    /// points: one to most_points of them, none of them the origin. Their least sum of |w| |p|^2 + misfit |sum of w
    /// p|^2, sum of |w| <= 2: where the points surround the origin, the corners of the Delaunay tetrahedron that
    /// contains it, as the first term lifts the points to a paraboloid; where they lie on a surface, three of them and
    /// the distance of the origin from their plane; never distant points.
    static affine_weights best(std::span<const vec3> points)
    {
        affine_search s(points);
        const std::size_t n = points.size();
        for (std::size_t i = 0; i < n; ++i)
        {
            s.one(i);
            for (std::size_t j = i + 1; j < n; ++j)
            {
                s.two(i, j);
                const vec3 ij = glm::cross(points[i], points[j]);
                for (std::size_t k = j + 1; k < n; ++k)
                {
                    s.three(i, j, k);
                    const double volume = glm::dot(ij, points[k]);
                    const vec3 jk = glm::cross(points[j], points[k]), ki = glm::cross(points[k], points[i]);
                    for (std::size_t l = k + 1; l < n; ++l)
                        s.four({i, j, k, l},
                               {-glm::dot(jk, points[l]), -glm::dot(ki, points[l]), -glm::dot(ij, points[l]), volume});
                }
            }
        }
        return s.best_;
    }

    static constexpr std::size_t most_points = 8; ///< more change little: half of all time would go into them

private:
    static constexpr double misfit = 10, largest_sum = 2;

    explicit affine_search(std::span<const vec3> points) : p_(points)
    {
        for (std::size_t i = 0; i < points.size(); ++i) squared_[i] = glm::dot(points[i], points[i]);
    }

    void one(std::size_t i) { offer((1 + misfit) * squared_[i], {i, i, i, i}, {1, 0, 0, 0}); }

    /// Closest point of an edge to the origin.
    void two(std::size_t i, std::size_t j)
    {
        const vec3 d = p_[j] - p_[i];
        const double t = -glm::dot(p_[i], d) / glm::dot(d, d);
        if (!(t > 0 && t < 1)) return;
        const vec3 rest = p_[i] + t * d;
        offer((1 - t) * squared_[i] + t * squared_[j] + misfit * glm::dot(rest, rest), {i, j, j, j}, {1 - t, t, 0, 0});
    }

    /// Projection of the origin to a plane.
    void three(std::size_t i, std::size_t j, std::size_t k)
    {
        const vec3 n = glm::cross(p_[j] - p_[i], p_[k] - p_[i]);
        const double nn = glm::dot(n, n), size = squared_[i] + squared_[j] + squared_[k];
        if (!(nn > 1e-6 * size * size)) return;
        const vec3 foot = glm::dot(n, p_[i]) / nn * n;
        const double a = glm::dot(n, glm::cross(p_[j] - foot, p_[k] - foot)) / nn,
                     b = glm::dot(n, glm::cross(p_[k] - foot, p_[i] - foot)) / nn, c = 1 - a - b;
        if (std::abs(a) + std::abs(b) + std::abs(c) > largest_sum) return;
        offer(std::abs(a) * squared_[i] + std::abs(b) * squared_[j] + std::abs(c) * squared_[k] +
                  misfit * glm::dot(foot, foot),
              {i, j, k, k}, {a, b, c, 0});
    }

    /// w: volumes that the barycentric coordinates of the origin are proportional to.
    void four(const std::array<std::size_t, 4>& at, std::array<double, 4> w)
    {
        const double sum = w[0] + w[1] + w[2] + w[3];
        double size = 0, cost = 0;
        for (std::size_t k = 0; k < 4; ++k)
        {
            size += std::abs(w[k]);
            cost += std::abs(w[k]) * squared_[at[k]];
        }
        if (!(size <= largest_sum * std::abs(sum)) || !(cost < cost_ * std::abs(sum))) return;
        for (double& x : w) x /= sum;
        offer(cost / std::abs(sum), at, w);
    }

    void offer(double cost, const std::array<std::size_t, 4>& at, const std::array<double, 4>& weights)
    {
        if (!(cost < cost_)) return;
        cost_ = cost;
        best_ = {at, weights};
    }

    std::span<const vec3> p_;
    std::array<double, most_points> squared_{};
    double cost_ = std::numeric_limits<double>::infinity();
    affine_weights best_;
};

} // namespace taut::impl
