// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include <taut/impl/core/energy/symmetric_matrix.hpp>
#include <taut/symbolic.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Result type of comparing two numbers: bool, or sym_bool of traced ones.
template <class Real>
using condition_of = decltype(std::declval<Real>() < std::declval<Real>());

/// Projection of the Hessian of an element to a positive semi-definite one: treatment of its negative eigenvalues.
enum class negative_eigenvalues
{
    clamped, ///< 0: the nearest matrix in the Frobenius norm
    absolute ///< without their sign (Chen et al. 2024, "Stabler neo-Hookean simulation: absolute eigenvalue filtering
             ///< for projected Newton"): short steps where the curvature is strong, whatever its sign
};

/// That as it applies to single eigenvalues.
template <class Real>
struct eigenvalue_filter
{
    condition_of<Real> projected = true; ///< where it does not hold, all stay as they are
    condition_of<Real> absolute = false;

    Real operator()(const Real& eigenvalue) const
    {
        using std::max;
        return select(projected, max(eigenvalue, select(absolute, -eigenvalue, Real(0.0))), eigenvalue);
    }
};

/// A symmetric matrix with its eigenvalues filtered. Traced, so that it runs in a kernel: a fixed number of sweeps of
/// cyclic Jacobi rotations, unrolled, with selects and square roots only (Golub, Van Loan, Matrix Computations, section
/// 8.5). Sweeps converge quadratically from the third or so on; for N = 4 the fifth leaves nothing in double, the
/// fourth in float.
template <class Real, int N>
class filtered_matrix
{
public:
    using real = Real;

    /// type: of the numbers, f32 or f64.
    static symmetric_matrix<real, N> of(const symmetric_matrix<real, N>& H, scalar_type type,
                                        const eigenvalue_filter<real>& filter = {})
    {
        const int sweeps = (type == scalar_type::f64 ? 5 : 4) + (N > 4 ? 2 : 0);
        filtered_matrix state(H);
        for (int sweep = 0; sweep < sweeps; ++sweep)
            for (int p = 0; p < N; ++p)
                for (int q = p + 1; q < N; ++q) state.rotate(p, q);
        auto result = state.composed({.projected = true, .absolute = filter.absolute});
        for (int j = 0; j < N; ++j)
            for (int i = 0; i <= j; ++i) result(i, j) = select(filter.projected, result(i, j), H(i, j));
        return result;
    }

private:
    /// In units of the largest entry, so that squares neither overflow nor matter where they underflow.
    explicit filtered_matrix(const symmetric_matrix<real, N>& H) : largest_(0.0)
    {
        for (int j = 0; j < N; ++j)
            for (int i = 0; i <= j; ++i) largest_ = max(largest_, abs(H(i, j)));
        const real scale = real(1.0) / select(largest_ > real(0.0), largest_, real(1.0));
        for (int j = 0; j < N; ++j)
            for (int i = 0; i < N; ++i)
            {
                if (i <= j) a_(i, j) = H(i, j) * scale;
                v_[i][j] = real(i == j ? 1.0 : 0.0);
            }
    }

    /// Makes entry (p, q) zero by the smaller of the two angles.
    void rotate(int p, int q)
    {
        const real zero = 0.0, one = 1.0;
        const real off = real(2.0) * a_(p, q), gap = a_(q, q) - a_(p, p);
        const real reach = abs(gap) + sqrt(gap * gap + off * off);
        const real signed_off = select(gap < zero, -off, off);
        const real t = select(reach > zero, signed_off / select(reach > zero, reach, one), zero);
        const real c = one / sqrt(one + t * t), s = t * c;

        const real shift = t * a_(p, q);
        a_(p, p) = a_(p, p) - shift;
        a_(q, q) = a_(q, q) + shift;
        a_(p, q) = zero;
        for (int k = 0; k < N; ++k)
        {
            if (k != p && k != q) turn(a_(k, p), a_(k, q), c, s);
            turn(v_[k][p], v_[k][q], c, s);
        }
    }

    static void turn(real& x, real& y, real c, real s)
    {
        const real turned = c * x - s * y;
        y = s * x + c * y;
        x = turned;
    }

    symmetric_matrix<real, N> composed(const eigenvalue_filter<real>& filter) const
    {
        symmetric_matrix<real, N> result;
        for (int j = 0; j < N; ++j)
            for (int i = 0; i <= j; ++i)
            {
                real sum = 0.0;
                for (int k = 0; k < N; ++k)
                {
                    const real eigenvalue = largest_ * filter(a_(k, k));
                    const real term = eigenvalue * v_[j][k] * v_[i][k];
                    sum = k == 0 ? term : sum + term;
                }
                result(i, j) = sum;
            }
        return result;
    }

    symmetric_matrix<real, N> a_;
    real v_[N][N]; ///< eigenvectors as columns
    real largest_;
};

} // namespace taut::impl
