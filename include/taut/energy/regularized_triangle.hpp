// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <taut/core/types.hpp>

namespace taut::detail
{

/// The regularised energy of a triangle (Garanzha et al. 2021, "Foldover-free maps in 50 lines of code"),
///
///     f(S) = (|S|^2 + area_weight (det S^2 + 1)) / chi,   chi = (det S + sqrt(eps^2 + det S^2)) / 2,
///
/// defined for inverted triangles too as long as eps > 0; with eps = 0 it is a barrier, +infinity where det S <= 0.
///
/// S = p + q, the sum of a similarity and a reflected one. With a = |p|, b = |q| the singular values are a + b and
/// |a - b|, det S = a^2 - b^2 and |S|^2 = 2 (a^2 + b^2), so f is a function of a and b: its Hessian has a 2 x 2 block
/// in the directions that change a and b, and one eigenvalue each, f_a / a and f_b / b, for turning p and q.
struct regularized_triangle
{
    using mode = std::array<double, 4>; ///< over (S[0][0], S[0][1], S[1][0], S[1][1])

    double value = 0;
    std::array<mode, 4> modes;         ///< eigenvectors of the Hessian, not normalised
    std::array<double, 4> stiffness{}; ///< their weights, not negative: sum of stiffness * mode mode^T
    mode gradient{};

    static double chi(double eps, double det)
    {
        const double r = std::hypot(eps, det);
        return det > 0 ? 0.5 * (det + r) : 0.5 * eps * (eps / (r - det)); // the sum would cancel
    }

    static double value_of(const mat2& S, double eps, double area_weight)
    {
        const double det = S[0][0] * S[1][1] - S[0][1] * S[1][0];
        if (eps == 0 && !(det > 0)) return std::numeric_limits<double>::infinity();
        return (norm2(S) + area_weight * (det * det + 1)) / chi(eps, det);
    }

    /// Value, gradient and the positive semi-definite part of the Hessian.
    regularized_triangle(const mat2& S, double eps, double area_weight)
    {
        const vec2 p(0.5 * (S[0][0] + S[1][1]), 0.5 * (S[0][1] - S[1][0]));
        const vec2 q(0.5 * (S[0][0] - S[1][1]), 0.5 * (S[0][1] + S[1][0]));
        const double a = glm::length(p), b = glm::length(q), det = (a - b) * (a + b);
        const vec2 u = a > 0 ? p / a : vec2(1, 0), v = b > 0 ? q / b : vec2(1, 0);

        // h = 1 / chi and its derivatives by det; G is what stands over chi, w = df/d(det) at constant |S|^2.
        const double r = std::hypot(eps, det), h = 1 / chi(eps, det), h1 = -h / r, h2 = 2 / (r * r * r);
        const double G = 2 * (a * a + b * b) + area_weight * (det * det + 1);
        const double w = 2 * area_weight * det * h + G * h1;
        const double w_det = 2 * area_weight * (h + 2 * det * h1) + G * h2;
        value = G * h;
        const double fa = 2 * a * (2 * h + w), fb = 2 * b * (2 * h - w);
        const double faa = 2 * (2 * h + w) + 4 * a * a * (4 * h1 + w_det);
        const double fbb = 2 * (2 * h - w) + 4 * b * b * (w_det - 4 * h1);
        const double fab = -4 * a * b * w_det;

        const double half = 0.5;
        const mode grow{half * u.x, half * u.y, -half * u.y, half * u.x};
        const mode turn{-half * u.y, half * u.x, -half * u.x, -half * u.y};
        const mode stretch{half * v.x, half * v.y, half * v.y, -half * v.x};
        const mode flip{-half * v.y, half * v.x, half * v.x, half * v.y};
        for (std::size_t i = 0; i < 4; ++i) gradient[i] = fa * grow[i] + fb * stretch[i];

        // Eigenvectors of [faa fab; fab fbb].
        const double mean = 0.5 * (faa + fbb), gap = 0.5 * (faa - fbb), radius = std::hypot(gap, fab);
        const double angle = 0.5 * std::atan2(fab, gap), c = std::cos(angle), s = std::sin(angle);
        for (std::size_t i = 0; i < 4; ++i)
        {
            modes[0][i] = c * grow[i] + s * stretch[i];
            modes[1][i] = -s * grow[i] + c * stretch[i];
        }
        modes[2] = turn;
        modes[3] = flip;
        stiffness = {std::max(0.0, mean + radius), std::max(0.0, mean - radius), std::max(0.0, 2 * (2 * h + w)),
                     std::max(0.0, 2 * (2 * h - w))};
    }

private:
    static double norm2(const mat2& S) { return glm::dot(S[0], S[0]) + glm::dot(S[1], S[1]); }
};

} // namespace taut::detail
