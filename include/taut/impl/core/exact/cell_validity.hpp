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

#include <taut/certify.hpp>
#include <taut/impl/core/exact/cell_tetrahedra.hpp>
#include <taut/impl/core/exact/predicates.hpp>

namespace taut::impl
{

/// A Jacobian determinant as a polynomial on the unit cube, of degree 2 along each axis, by its 27 Bernstein
/// coefficients: it lies between the least and the greatest of them, and at the cube's corners has those at the
/// corners.
struct jacobian_polynomial
{
    std::array<double, 27> c{}; ///< at I + 3 J + 9 K
    double error = 0;           ///< bound of what is wrong with any coefficient

    static std::size_t at(std::size_t i, std::size_t j, std::size_t k) { return i + 3 * j + 9 * k; }

    /// Adds weight * det[e, f, g] to a coefficient. The edges are differences of coordinates, rounded once.
    void add(std::size_t place, double weight, const vec3& e, const vec3& f, const vec3& g)
    {
        constexpr double u = std::numeric_limits<double>::epsilon() / 2;
        double det = 0, terms = 0;
        for (int x = 0; x < 3; ++x)
        {
            const int y = (x + 1) % 3, z = (x + 2) % 3;
            const double left = f[y] * g[z], right = f[z] * g[y];
            det += e[x] * (left - right);
            terms += std::abs(e[x]) * (std::abs(left) + std::abs(right));
        }
        c[place] += weight * det;
        // As in orient(); 8 terms at most are added up. A product that underflows is off by one tiny number, scaled.
        const double tiny = (1 + std::abs(e.x) + std::abs(e.y) + std::abs(e.z)) * std::numeric_limits<double>::min();
        error = std::max(error, 24 * u * terms + 2 * tiny);
    }
};

/// The two halves along an axis, by de Casteljau's algorithm.
inline std::pair<jacobian_polynomial, jacobian_polynomial> halves(const jacobian_polynomial& p, std::size_t axis)
{
    constexpr std::array<std::size_t, 3> strides = {1, 3, 9};
    const std::size_t s = strides[axis];
    std::pair<jacobian_polynomial, jacobian_polynomial> result{p, p};
    double largest = 0;
    for (std::size_t first = 0; first < 27; ++first)
    {
        largest = std::max(largest, std::abs(p.c[first]));
        if (first / s % 3 != 0) continue;
        const double a = p.c[first], b = p.c[first + s], c = p.c[first + 2 * s];
        const double ab = 0.5 * a + 0.5 * b, bc = 0.5 * b + 0.5 * c, middle = 0.5 * ab + 0.5 * bc;
        auto &low = result.first.c, &high = result.second.c;
        low[first + s] = ab;
        low[first + 2 * s] = high[first] = middle;
        high[first + s] = bc;
    }
    result.first.error = result.second.error = p.error + 2 * std::numeric_limits<double>::epsilon() * largest;
    return result;
}

/// Axis along which the coefficients are farthest from linear, to be halved.
inline std::size_t most_curved_axis(const jacobian_polynomial& p)
{
    std::array<double, 3> most{};
    constexpr std::array<std::size_t, 3> strides = {1, 3, 9};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t first = 0; first < 27; ++first)
            if (const std::size_t s = strides[axis]; first / s % 3 == 0)
                most[axis] = std::max(most[axis], std::abs(p.c[first] - 2 * p.c[first + s] + p.c[first + 2 * s]));
    return static_cast<std::size_t>(std::max_element(most.begin(), most.end()) - most.begin());
}

/// Decides by bounds and bisection; boxes: maximum number of parts.
inline cell_validity validity_of(const jacobian_polynomial& whole, std::size_t boxes)
{
    std::vector<jacobian_polynomial> open{whole};
    for (; !open.empty(); --boxes)
    {
        const jacobian_polynomial p = open.back();
        open.pop_back();
        if (!std::all_of(p.c.begin(), p.c.end(), [](double c) { return finite(c); })) return cell_validity::undecided;
        double corner = p.c[0];
        for (const std::size_t i : {0, 2})
            for (const std::size_t j : {0, 2})
                for (const std::size_t k : {0, 2}) corner = std::min(corner, p.c[p.at(i, j, k)]);
        if (corner < -p.error) return cell_validity::invalid;
        if (*std::min_element(p.c.begin(), p.c.end()) > p.error) continue;
        if (corner <= p.error || boxes == 0) return cell_validity::undecided; // no part has a better corner
        auto [low, high] = halves(p, most_curved_axis(p));
        open.push_back(low);
        open.push_back(high);
    }
    return cell_validity::valid;
}

/// A trilinear map: its derivatives along the three axes are bilinear in the other two.
inline jacobian_polynomial hexahedron_jacobian(std::span<const vec3> x)
{
    // Corner (i, j, k) of the cube in VTK's order.
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k) { return x[4 * k + (j == 0 ? i : 3 - i)]; };
    jacobian_polynomial p;
    constexpr std::array<double, 3> weight = {1, 0.5, 1}; // of the products of two linear functions
    for (std::size_t m = 0; m < 64; ++m)
    {
        const std::size_t j = m & 1, k = m >> 1 & 1, i = m >> 2 & 1, k2 = m >> 3 & 1, i2 = m >> 4 & 1, j2 = m >> 5;
        const std::size_t I = i + i2, J = j + j2, K = k + k2;
        p.add(p.at(I, J, K), weight[I] * weight[J] * weight[K], at(1, j, k) - at(0, j, k), at(i, 1, k2) - at(i, 0, k2),
              at(i2, j2, 1) - at(i2, j2, 0));
    }
    return p;
}

/// A triangle that moves along a line at each corner: linear over the triangle, so that three corners tell, at each of
/// which it is quadratic along the third axis.
inline std::array<jacobian_polynomial, 3> wedge_jacobians(std::span<const vec3> x)
{
    std::array<jacobian_polynomial, 3> result;
    for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t place = 0; place < 9; ++place)
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t k2 = 0; k2 < 2; ++k2)
                    result[corner].add(place + 9 * (k + k2), k == k2 ? 1 : 0.5, x[3 * k + 2] - x[3 * k],
                                       x[3 * k2 + 1] - x[3 * k2], x[corner + 3] - x[corner]);
    return result;
}

/// A bilinear base that shrinks towards the apex A: the determinant is (1 - w)^2 det[Q_u, Q_v, A - Q] of the base Q.
inline jacobian_polynomial pyramid_jacobian(std::span<const vec3> x)
{
    const auto at = [&](std::size_t i, std::size_t j) { return x[j == 0 ? i : 3 - i]; };
    jacobian_polynomial p;
    constexpr std::array<double, 3> weight = {1, 0.5, 1};
    for (std::size_t K = 0; K < 3; ++K)
        for (std::size_t m = 0; m < 16; ++m)
        {
            const std::size_t i = m & 1, i2 = m >> 1 & 1, j = m >> 2 & 1, j2 = m >> 3;
            p.add(p.at(i + i2, j + j2, K), weight[i + i2] * weight[j + j2], at(1, j) - at(0, j), at(i, 1) - at(i, 0),
                  x[4] - at(i2, j2));
        }
    return p;
}

/// Returns whether a simplex at a corner of the cell is not positive, by exact signs.
inline bool has_bad_corner(std::span<const vec3> x)
{
    const auto all = corner_tetrahedra(x.size());
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& t) { return orient3d(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) <= 0; });
}

} // namespace taut::impl
