// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/impl/energy/eigenvalue_filter.hpp>
#include <taut/impl/energy/element.hpp>
#include <taut/impl/energy/isometric.hpp>
#include <taut/impl/energy/modes.hpp>
#include <taut/impl/mesh/thin_shell.hpp>
#include <taut/impl/symbolic/differentiate.hpp>

namespace taut::energy
{

/// Thin shell energy, summed over the hinges of a surface (mesh/hinge.hpp); 0 at rest and at its rigid motions.
///
///     sum over both triangles of share (tr G (1 + 1/det G) - 4) + h^2 / 3 |e|^2 / (A + A') (2 tan(d/2))^2
///
/// G = J'J of the 3 x 2 Jacobian J of a triangle: the symmetric Dirichlet energy of its singular values, +infinity
/// where it has no area. d: by how much the angle at the hinge differs from that at rest; 2 tan(d/2), which is d where
/// it is small, is smooth and forbids that a hinge closes. The bending energy is that of discrete shells (Grinspun,
/// Hirani, Desbrun, Schroeder 2003) with the factor of a plate of thickness h: bent with curvature k, its strain at
/// height z is zk, and the stretching energy near rest is 4 strain^2, so 4 k^2 h^2 / 12 in the mean; the sum of |e|^2 /
/// (A + A') d^2 is the integral of k^2 on regular triangles (Seung, Nelson 1988).
///
/// Attributes: shell_attributes. Parameter 0: h in units of thin_shell::mean_edge().
struct shell
{
    static constexpr bool barrier = false; // of det S, which has no meaning

    template <class T>
    T operator()(const element<T, 3>& e) const
    {
        const T t = half_tangent(e), h = e.parameter(0);
        return e.attribute(taut::impl::shell_attributes::shares) * stretching(membrane<T>(e, 0)) +
               e.attribute(taut::impl::shell_attributes::shares + 1) * stretching(membrane<T>(e, 1)) +
               h * h * e.attribute(taut::impl::shell_attributes::bending) * (T(4.0 / 3) * t * t);
    }

    /// Second derivatives by the entries of S, by columns. Filtered, the stretching energy of each triangle has its own
    /// eigenvalues filtered, and bending has what Gauss and Newton's method has, which is positive.
    template <class T>
    taut::impl::symmetric_matrix<T, 9> hessian(const element<T, 3>& e, const taut::impl::eigenvalue_filter<T>& filter,
                                               scalar_type type) const
    {
        taut::impl::symmetric_matrix<T, 9> H;
        for (int j = 0; j < 9; ++j)
            for (int i = 0; i <= j; ++i) H(i, j) = T(0.0);
        for (const std::size_t side : {0U, 1U})
            add_stretching(membrane<T>(e, side), e.attribute(taut::impl::shell_attributes::shares + side), filter, type,
                           H);

        const T h = e.parameter(0), t = half_tangent(e);
        const T twice = T(8.0 / 3) * h * h * e.attribute(taut::impl::shell_attributes::bending);
        std::vector<T> entries;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) entries.push_back(e.S[c][r]);
        const auto slope = differentiate(t, entries);
        const T rest = select(filter.projected, T(0.0), twice * t);
        for (std::size_t j = 0; j < 9; ++j)
        {
            const std::vector<T> upper(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(j) + 1);
            const auto row = differentiate(slope[j], upper);
            for (std::size_t i = 0; i <= j; ++i)
            {
                T& entry = H(static_cast<int>(i), static_cast<int>(j));
                entry = entry + (twice * slope[i] * slope[j] + rest * row[i]);
            }
        }
        return H;
    }

private:
    template <class T>
    using vec3_of = glm::vec<3, T>;

    /// J of one of the triangles as columns, J = [S0, S_edge] B, with B upper triangular.
    template <class T>
    struct jacobian
    {
        int edge;
        T b00, b01, b11;
        vec3_of<T> x, y;
        vec3_of<T> normal; ///< x cross y
        T square;          ///< det G
    };

    template <class T>
    static jacobian<T> membrane(const element<T, 3>& e, std::size_t side)
    {
        const std::size_t at = side == 0 ? taut::impl::shell_attributes::first : taut::impl::shell_attributes::second;
        jacobian<T> j{side == 0 ? 1 : 2, e.attribute(at), e.attribute(at + 1), e.attribute(at + 2), {}, {}, {}, {}};
        j.x = e.S[0] * j.b00;
        j.y = e.S[0] * j.b01 + e.S[j.edge] * j.b11;
        j.normal = glm::cross(j.x, j.y);
        j.square = glm::dot(j.normal, j.normal);
        return j;
    }

    template <class T>
    static T stretching(const jacobian<T>& j)
    {
        const T trace = glm::dot(j.x, j.x) + glm::dot(j.y, j.y);
        const T some = select(j.square > T(0.0), j.square, T(1.0));
        return select(j.square > T(0.0), trace * (T(1.0) + T(1.0) / some) - T(4.0),
                      T(std::numeric_limits<double>::infinity()));
    }

    /// tan(d / 2) from cosines and sines: sin d / (1 + cos d).
    template <class T>
    static T half_tangent(const element<T, 3>& e)
    {
        using std::sqrt;
        const auto a = glm::cross(e.S[0], e.S[1]), b = glm::cross(e.S[2], e.S[0]);
        const T areas = sqrt(glm::dot(a, a) * glm::dot(b, b));
        const T c = glm::dot(a, b) / areas, s = sqrt(glm::dot(e.S[0], e.S[0])) * glm::dot(a, e.S[2]) / areas;
        const T c0 = e.attribute(taut::impl::shell_attributes::cosine),
                s0 = e.attribute(taut::impl::shell_attributes::sine);
        return (s * c0 - c * s0) / (T(1.0) + (c * c0 + s * s0));
    }

    /// In a frame (u, v) of the image J = (u, v) R with R of 2 x 2, along which plane_modes has the Hessian; across it
    /// that is 2 dE/dG = 2 psi_I + psi_d / d adj G, for each coordinate of the domain.
    template <class T>
    static void add_stretching(const jacobian<T>& j, const T& weight, const taut::impl::eigenvalue_filter<T>& filter,
                               scalar_type type, taut::impl::symmetric_matrix<T, 9>& H)
    {
        using std::sqrt;
        const T xx = glm::dot(j.x, j.x), xy = glm::dot(j.x, j.y), yy = glm::dot(j.y, j.y);
        const T length = sqrt(xx), d = sqrt(j.square), zero = T(0.0);
        const vec3_of<T> u = j.x * (T(1.0) / length), n = j.normal * (T(1.0) / d), v = glm::cross(n, u);
        const glm::mat<2, 2, T> R(length, zero, xy / length, d / length);
        const auto psi = isometric::derivatives(xx + yy, d);
        const auto along = taut::impl::plane_modes<T>(R, psi, filter).hessian(weight);
        taut::impl::symmetric_matrix<T, 2> across;
        const T shear = psi.by_d / d;
        across(0, 0) = T(2.0) * psi.by_I + shear * yy;
        across(0, 1) = -(shear * xy);
        across(1, 1) = T(2.0) * psi.by_I + shear * xx;
        across = taut::impl::filtered_matrix<T, 2>::of(across, type, filter);

        // Over the entries of J, number 3 c + r, then over those of S.
        const auto of_jacobian = [&](int c, int r, int k, int s)
        {
            return u[r] * (along(2 * c, 2 * k) * u[s] + along(2 * c, 2 * k + 1) * v[s]) +
                   v[r] * (along(2 * c + 1, 2 * k) * u[s] + along(2 * c + 1, 2 * k + 1) * v[s]) +
                   weight * across(c, k) * n[r] * n[s];
        };
        for (int r = 0; r < 3; ++r)
            for (int s = 0; s < 3; ++s)
            {
                const T h00 = of_jacobian(0, r, 0, s), h01 = of_jacobian(0, r, 1, s), h11 = of_jacobian(1, r, 1, s),
                        h10 = of_jacobian(1, r, 0, s);
                // x and y of J by S0 and the other edge: (b00, 0) and (b01, b11).
                if (r <= s)
                {
                    H(r, s) = H(r, s) + (j.b00 * (j.b00 * h00 + j.b01 * (h01 + h10)) + j.b01 * j.b01 * h11);
                    T& far = H(3 * j.edge + r, 3 * j.edge + s);
                    far = far + j.b11 * j.b11 * h11;
                }
                T& mixed = H(r, 3 * j.edge + s);
                mixed = mixed + j.b11 * (j.b00 * h01 + j.b01 * h11);
            }
    }
};

} // namespace taut::energy
