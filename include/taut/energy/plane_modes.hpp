// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <array>
#include <cstddef>

#include <taut/energy/isotropic.hpp>
#include <taut/energy/symmetric_matrix.hpp>

namespace taut
{

/// The Hessian of an isotropic energy psi(I, d) of the plane by the four entries of S (by columns), through its
/// eigen-decomposition in closed form; `projected` clamps negative eigenvalues at 0.
///
/// Half sums and differences of the entries split S into a similarity p and a reflected one q, two vectors of the
/// plane with |p| = (s1 + s2)/2 and |q| = (s1 - s2)/2. Three eigenspaces follow (compare Smith, de Goes, Kim 2019,
/// "Analytic eigensystems for isotropic distortion energies"):
///
///   twist    p turns:  2 psi_I + psi_d
///   flip     q turns:  2 psi_I - psi_d
///   scaling  s1 and s2 change: the Hessian of E(s1, s2), a 2 x 2 block
///
/// Nothing is divided by s1 - s2. The direction of q is lost to rounding as s1 - s2 goes to 0, where flip and the block
/// agree on all directions of q, so that any direction does. The block stands in s1 and s2, not in p and q: on a sliver
/// its small curvature is an entry of its own there and not a difference of large ones.
///
/// Real is double or a traced scalar.
template <class Real>
class plane_modes
{
public:
    using real = Real;

    plane_modes(const glm::mat<2, 2, real>& S, const invariant_derivatives<real>& psi, bool projected)
        : twist_(real(2.0) * psi.by_I + psi.by_d), flip_(real(2.0) * psi.by_I - psi.by_d)
    {
        const real half = 0.5;
        const unit p(half * (S[0][0] + S[1][1]), half * (S[0][1] - S[1][0]));
        const unit q(half * (S[0][0] - S[1][1]), half * (S[0][1] + S[1][0]));
        turns_p_ = {-p.y, p.x, -p.x, -p.y};
        turns_q_ = {-q.y, q.x, q.x, q.y};
        grows_1_ = {p.x + q.x, p.y + q.y, q.y - p.y, p.x - q.x};
        grows_2_ = {p.x - q.x, p.y - q.y, -q.y - p.y, p.x + q.x};

        // s2 from the determinant: |p| - |q| would cancel. It has the sign of det S.
        const real s1 = p.length + q.length;
        const real s2 = select(s1 > real(0.0), psi.d / s1, real(0.0));
        const real four = 4.0;
        const auto curvature = [&](real s, real other)
        { return real(2.0) * psi.by_I + four * (s * s * psi.by_II + psi.d * psi.by_Id) + other * other * psi.by_dd; };
        b11_ = curvature(s1, s2);
        b22_ = curvature(s2, s1);
        b12_ = psi.by_d + four * psi.d * psi.by_II + real(2.0) * psi.I * psi.by_Id + psi.d * psi.by_dd;
        if (projected) project();
    }

    symmetric_matrix<real, 4> hessian(real weight) const
    {
        // The modes below are unit vectors times sqrt(2) (turns) and 2 (grows).
        const real twist = real(0.5) * weight * twist_, flip = real(0.5) * weight * flip_;
        const real quarter = real(0.25) * weight;
        const real b11 = quarter * b11_, b12 = quarter * b12_, b22 = quarter * b22_;
        symmetric_matrix<real, 4> H;
        for (int j = 0; j < 4; ++j)
        {
            const auto at = static_cast<std::size_t>(j);
            const real t = twist * turns_p_[at], f = flip * turns_q_[at];
            const real one = b11 * grows_1_[at] + b12 * grows_2_[at];
            const real two = b12 * grows_1_[at] + b22 * grows_2_[at];
            for (std::size_t i = 0; i <= at; ++i)
                H(static_cast<int>(i), j) = turns_p_[i] * t + turns_q_[i] * f + (grows_1_[i] * one + grows_2_[i] * two);
        }
        return H;
    }

private:
    using mode = std::array<real, 4>;

    /// A vector of the plane as length and direction; the direction of 0 is the first axis.
    struct unit
    {
        unit(real a, real b)
        {
            using std::sqrt;
            length = sqrt(a * a + b * b);
            const auto some = length > real(0.0);
            const real scale = real(1.0) / select(some, length, real(1.0));
            x = select(some, a * scale, real(1.0));
            y = b * scale;
        }
        real length, x, y;
    };

    void project()
    {
        using std::abs, std::max, std::sqrt;
        const real zero = 0.0, half = 0.5;
        twist_ = max(twist_, zero);
        flip_ = max(flip_, zero);

        // The 2 x 2 block in units of its largest entry, so that no square overflows.
        const real largest = max(max(abs(b11_), abs(b22_)), abs(b12_));
        const real scale = real(1.0) / select(largest > zero, largest, real(1.0));
        const real a = b11_ * scale, b = b12_ * scale, c = b22_ * scale;
        const real trace = a + c, det = a * c - b * b, delta = a - c;
        const real root = sqrt(delta * delta + real(4.0) * b * b);
        // Of two signs, what remains is the positive eigenvalue times its projector (1 + (B - trace/2) / (root/2)) / 2.
        const real split = real(1.0) / select(root > zero, root, real(1.0));
        const real positive = half * largest * (half * (trace + root));
        const auto mixed = det < zero;
        const auto none = trace < zero;
        const auto choose = [&](real kept, real one_mode) { return select(mixed, one_mode, select(none, zero, kept)); };
        b11_ = choose(b11_, positive * (real(1.0) + delta * split));
        b22_ = choose(b22_, positive * (real(1.0) - delta * split));
        b12_ = choose(b12_, positive * (real(2.0) * b * split));
    }

    mode turns_p_, turns_q_, grows_1_, grows_2_;
    real twist_, flip_;
    real b11_, b12_, b22_;
};

} // namespace taut
