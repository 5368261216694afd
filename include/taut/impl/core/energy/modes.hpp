// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/energy/eigenvalue_filter.hpp>
#include <taut/impl/core/energy/invariants.hpp>
#include <taut/impl/core/energy/symmetric_matrix.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// The Hessian of an isotropic energy psi(I, d) of the plane by the four entries of S (by columns), through its
/// eigen-decomposition in closed form, its eigenvalues filtered.
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
    using filter_type = eigenvalue_filter<real>;

    plane_modes(const glm::mat<2, 2, real>& S, const invariant_derivatives<real>& psi, const filter_type& filter)
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
        apply(filter);
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

    void apply(const filter_type& filter)
    {
        using std::abs, std::max, std::sqrt;
        const real zero = 0.0, half = 0.5;
        twist_ = filter(twist_);
        flip_ = filter(flip_);

        // The 2 x 2 block in units of its largest entry, so that no square overflows.
        const real largest = max(max(abs(b11_), abs(b22_)), abs(b12_));
        const real scale = real(1.0) / select(largest > zero, largest, real(1.0));
        const real a = b11_ * scale, b = b12_ * scale, c = b22_ * scale;
        const real trace = a + c, det = a * c - b * b, delta = a - c;
        const real root = sqrt(delta * delta + real(4.0) * b * b);
        // Of two signs, clamping leaves the positive eigenvalue times its projector (1 + (B - trace/2) / (root/2)) / 2,
        // and absolute values are twice that less B.
        const real split = real(1.0) / select(root > zero, root, real(1.0));
        const real positive = half * largest * (half * (trace + root));
        const auto mixed = filter.projected && det < zero;
        const auto none = filter.projected && trace < zero;
        const auto choose = [&](real kept, real one_mode)
        {
            const real of_mixed = select(filter.absolute, one_mode + (one_mode - kept), one_mode);
            return select(mixed, of_mixed, select(none, select(filter.absolute, -kept, zero), kept));
        };
        b11_ = choose(b11_, positive * (real(1.0) + delta * split));
        b22_ = choose(b22_, positive * (real(1.0) - delta * split));
        b12_ = choose(b12_, positive * (real(2.0) * b * split));
    }

    mode turns_p_, turns_q_, grows_1_, grows_2_;
    real twist_, flip_;
    real b11_, b12_, b22_;
};

/// The same in space: the Hessian of psi(I, d) by the nine entries of S (by columns). With S = U diag(s) V', for each
/// pair of axes i, j and the third one k:
///
///   twist    u_i v_j' - u_j v_i'   2 psi_I + s_k psi_d
///   flip     u_i v_j' + u_j v_i'   2 psi_I - s_k psi_d
///   scaling  u_i v_i'              the Hessian of E(s1, s2, s3), a 3 x 3 block
///
/// The singular vectors come from rotations of the columns of S until they are orthogonal (Hestenes 1958), which keeps
/// the digits of small singular values; s3 comes from the determinant and has its sign.
template <class Real>
class space_modes
{
public:
    using real = Real;

    /// type: of the numbers, f32 or f64.
    space_modes(const glm::mat<3, 3, real>& S, const invariant_derivatives<real>& psi, scalar_type type,
                const eigenvalue_filter<real>& filter)
    {
        decompose(S, psi.d, type);
        const real two = 2.0, four = 4.0;
        for (int k = 0; k < 3; ++k)
        {
            twist_[k] = filter(two * psi.by_I + s_[k] * psi.by_d);
            flip_[k] = filter(two * psi.by_I - s_[k] * psi.by_d);
        }
        const real g[3] = {s_[1] * s_[2], s_[2] * s_[0], s_[0] * s_[1]}; // derivatives of d by s
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i <= j; ++i)
            {
                const real mixed = s_[i] * g[j] + s_[j] * g[i];
                const real both =
                    four * (s_[i] * s_[j] * psi.by_II) + two * (mixed * psi.by_Id) + g[i] * g[j] * psi.by_dd;
                block_(i, j) = i == j ? two * psi.by_I + both : s_[3 - i - j] * psi.by_d + both;
            }
        block_ = filtered_matrix<real, 3>::of(block_, type, filter);
    }

    symmetric_matrix<real, 9> hessian(real weight) const
    {
        symmetric_matrix<real, 9> H;
        const real half = real(0.5) * weight;
        std::vector<mode> left, right; // H is the sum of left[n] right[n]'
        for (int k = 0; k < 3; ++k)
        {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const mode a = outer(i, j), b = outer(j, i);
            add(left, right, combined(1.0, a, -1.0, b), half * twist_[k]);
            add(left, right, combined(1.0, a, 1.0, b), half * flip_[k]);
        }
        const mode grows[3] = {outer(0, 0), outer(1, 1), outer(2, 2)};
        for (int i = 0; i < 3; ++i)
        {
            mode image;
            for (std::size_t n = 0; n < 9; ++n)
                image[n] =
                    weight * (block_(i, 0) * grows[0][n] + block_(i, 1) * grows[1][n] + block_(i, 2) * grows[2][n]);
            left.push_back(grows[i]);
            right.push_back(image);
        }
        for (int j = 0; j < 9; ++j)
            for (int i = 0; i <= j; ++i)
            {
                const auto row = static_cast<std::size_t>(i), entry = static_cast<std::size_t>(j);
                real sum = left[0][row] * right[0][entry];
                for (std::size_t n = 1; n < left.size(); ++n) sum = sum + left[n][row] * right[n][entry];
                H(i, j) = sum;
            }
        return H;
    }

private:
    using mode = std::array<real, 9>;
    using column = glm::vec<3, real>;

    /// u_i v_j' by columns.
    mode outer(int i, int j) const
    {
        mode m;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) m[static_cast<std::size_t>(3 * c + r)] = u_[i][r] * v_[j][c];
        return m;
    }
    static mode combined(double a, const mode& x, double b, const mode& y)
    {
        mode m;
        for (std::size_t n = 0; n < 9; ++n) m[n] = real(a) * x[n] + real(b) * y[n];
        return m;
    }
    static void add(std::vector<mode>& left, std::vector<mode>& right, const mode& m, const real& factor)
    {
        mode image;
        for (std::size_t n = 0; n < 9; ++n) image[n] = factor * m[n];
        left.push_back(m);
        right.push_back(image);
    }

    void decompose(const glm::mat<3, 3, real>& S, const real& d, scalar_type type)
    {
        const real zero = 0.0, one = 1.0;
        column b[3] = {S[0], S[1], S[2]}; // S V
        for (int k = 0; k < 3; ++k)
            for (int r = 0; r < 3; ++r) v_[k][r] = real(r == k ? 1.0 : 0.0);
        const int sweeps = type == scalar_type::f64 ? 6 : 5;
        for (int sweep = 0; sweep < sweeps; ++sweep)
            for (int p = 0; p < 3; ++p)
                for (int q = p + 1; q < 3; ++q) make_orthogonal(b[p], b[q], v_[p], v_[q]);
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
        {
            // The longer column first; one changes its sign, so that V stays a rotation.
            const auto swap = glm::dot(b[p], b[p]) < glm::dot(b[q], b[q]);
            for (column* pair : {b, v_})
                for (int r = 0; r < 3; ++r)
                {
                    const real x = pair[p][r], y = pair[q][r];
                    pair[p][r] = select(swap, y, x);
                    pair[q][r] = select(swap, -x, y);
                }
        }
        u_[0] = direction(b[0], column(one, zero, zero));
        s_[0] = glm::dot(u_[0], b[0]);
        // Of a column that is lost in rounding, any direction across the first one.
        const column rest = b[1] - glm::dot(u_[0], b[1]) * u_[0];
        u_[1] = direction(rest, across(u_[0]));
        s_[1] = glm::dot(u_[1], b[1]);
        u_[2] = glm::cross(u_[0], u_[1]);
        const real area = s_[0] * s_[1];
        s_[2] = select(area > zero, d / select(area > zero, area, one), zero);
    }

    /// Turns two columns until they are orthogonal, by the smaller of the two angles.
    static void make_orthogonal(column& x, column& y, column& v, column& w)
    {
        using std::abs, std::sqrt;
        const real zero = 0.0, one = 1.0;
        const real off = real(2.0) * glm::dot(x, y), gap = glm::dot(y, y) - glm::dot(x, x);
        const real reach = abs(gap) + sqrt(gap * gap + off * off);
        const real t = select(reach > zero, select(gap < zero, -off, off) / select(reach > zero, reach, one), zero);
        const real c = one / sqrt(one + t * t), s = t * c;
        const auto turn = [&](column& from, column& to)
        {
            const column turned = c * from - s * to;
            to = s * from + c * to;
            from = turned;
        };
        turn(x, y);
        turn(v, w);
    }

    static column direction(const column& x, const column& otherwise)
    {
        using std::sqrt;
        const real zero = 0.0, square = glm::dot(x, x);
        const real scale = real(1.0) / sqrt(select(square > zero, square, real(1.0)));
        column result;
        for (int r = 0; r < 3; ++r) result[r] = select(square > zero, x[r] * scale, otherwise[r]);
        return result;
    }

    /// A unit vector orthogonal to one.
    static column across(const column& x)
    {
        const real zero = 0.0;
        const auto steep = x[0] * x[0] > real(0.5);
        const column axis(select(steep, zero, real(1.0)), select(steep, real(1.0), zero), zero);
        return direction(glm::cross(x, axis), column(zero, zero, real(1.0)));
    }

    column u_[3], v_[3];
    real s_[3], twist_[3], flip_[3];
    symmetric_matrix<real, 3> block_;
};

} // namespace taut::impl
