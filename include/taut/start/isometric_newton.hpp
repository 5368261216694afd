// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/hierarchy/detail/star_region.hpp>
#include <taut/mesh/first_flip.hpp>
#include <taut/mesh/ideal.hpp>
#include <taut/sparse/front_cholesky.hpp>

namespace taut::detail
{

/// Isometric energy of a small surface, sum over triangles of area |S|^2 (1 + 1/det S^2), and Newton's method on it
/// with the Hessian of each triangle projected to positive semi-definite and a direct solver.
class isometric_newton
{
public:
    /// fixed: one flag a vertex; these are not moved. All of it in one unit of length. The cells are referred to.
    isometric_newton(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells,
                     std::span<const char> fixed)
        : cells_(cells), solver_(cells, fixed), blocks_(cells.size())
    {
        for (const auto& t : cells)
        {
            const mat2 W = triangle::ideal({points[u(t[0])], points[u(t[1])], points[u(t[2])]});
            // Flat triangles at rest have no ideal element; a height near 0 makes them stiff instead.
            mat2 ideal = W;
            ideal[1][1] = std::max(W[1][1], 1e-6 * W[0][0]);
            inverse_.push_back(invert_upper(ideal));
            area_.push_back(0.5 * ideal[0][0] * ideal[1][1]);
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
            const double det = glm::determinant(S);
            sum += area_[c] * norm2(S) * (1 + 1 / (det * det));
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
    static double norm2(const mat2& S) { return glm::dot(S[0], S[0]) + glm::dot(S[1], S[1]); }

    mat2 mapped(std::span<const vec2> x, std::size_t c) const
    {
        const auto& t = cells_[c];
        return mat2(x[u(t[1])] - x[u(t[0])], x[u(t[2])] - x[u(t[0])]) * inverse_[c];
    }

    /// Sets the triangle's block and adds its negative gradient.
    void derivatives(std::span<const vec2> x, std::size_t c, std::vector<vec2>& force)
    {
        const mat2 S = mapped(x, c);
        // S = p + q, a similarity and a reflected one; |p| +- |q| are the singular values.
        const vec2 p(0.5 * (S[0][0] + S[1][1]), 0.5 * (S[0][1] - S[1][0]));
        const vec2 q(0.5 * (S[0][0] - S[1][1]), 0.5 * (S[0][1] + S[1][0]));
        const double lp = glm::length(p), lq = glm::length(q), s1 = lp + lq, det = glm::determinant(S), s2 = det / s1;
        const vec2 a = lp > 0 ? p / lp : vec2(1, 0), b = lq > 0 ? q / lq : vec2(1, 0);

        // Eigenvectors over (S00, S01, S10, S11) and eigenvalues; E = s1^2 + s2^2 + 1/s1^2 + 1/s2^2.
        using mode = std::array<double, 4>;
        const double half = 0.5, root = std::numbers::sqrt2 / 2;
        const mode grow1{half * (a.x + b.x), half * (a.y + b.y), half * (b.y - a.y), half * (a.x - b.x)};
        const mode grow2{half * (a.x - b.x), half * (a.y - b.y), half * (-b.y - a.y), half * (a.x + b.x)};
        const mode twist{-root * a.y, root * a.x, -root * a.x, -root * a.y};
        const mode flip{-root * b.y, root * b.x, root * b.x, root * b.y};
        const double i1 = 1 / s1, i2 = 1 / s2, product = i1 * i2;
        const double first = 2 * (s1 - i1 * i1 * i1), second = 2 * (s2 - i2 * i2 * i2);
        const double stiff1 = 2 + 6 * i1 * i1 * i1 * i1, stiff2 = 2 + 6 * i2 * i2 * i2 * i2;
        const double mixed = product * product * product;
        const double stiff_twist = std::max(0.0, 2 - 2 * (s1 * s1 - s1 * s2 + s2 * s2) * mixed);
        const double stiff_flip = 2 + 2 * (s1 * s1 + s1 * s2 + s2 * s2) * mixed;

        // dS = dA W^-1: how S moves with the corners.
        const mat2& w = inverse_[c];
        const std::array<vec2, 3> shape{vec2(-w[0][0] - w[0][1], -w[1][0] - w[1][1]), vec2(w[0][0], w[1][0]),
                                        vec2(w[0][1], w[1][1])};
        std::array<std::array<double, 6>, 4> moved{};
        const std::array<const mode*, 4> modes{&grow1, &grow2, &twist, &flip};
        for (std::size_t m = 0; m < 4; ++m)
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t r = 0; r < 2; ++r)
                    moved[m][2 * k + r] = (*modes[m])[r] * shape[k].x + (*modes[m])[2 + r] * shape[k].y;
        const std::array<double, 4> stiff{area_[c] * stiff1, area_[c] * stiff2, area_[c] * stiff_twist,
                                          area_[c] * stiff_flip};
        auto& H = blocks_[c];
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j)
            {
                H[i][j] = 0;
                for (std::size_t m = 0; m < 4; ++m) H[i][j] += stiff[m] * moved[m][i] * moved[m][j];
            }
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t r = 0; r < 2; ++r)
                force[u(cells_[c][k])][static_cast<int>(r)] -=
                    area_[c] * (first * moved[0][2 * k + r] + second * moved[1][2 * k + r]);
    }

    std::span<const std::array<idx, 3>> cells_;
    std::vector<mat2> inverse_;
    std::vector<double> area_;
    double total_ = 0;
    front_cholesky solver_;
    std::vector<front_cholesky::block> blocks_;
};

} // namespace taut::detail
