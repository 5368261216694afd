// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <taut/types.hpp>

namespace taut::impl
{

/// The smallest a > 0 at which det(A + a B) = 0 for a triangle with det A > 0; +infinity if it never vanishes.
///
/// det(A + a B) = q a^2 + b a + c is a quadratic with c > 0, so its first positive root is 2c / (sqrt(b^2 - 4qc) - b)
/// where that is positive, and there is none where it is not. For b > 0 the denominator cancels; the conjugate form
/// (sqrt + b) / (-2q) does not. No iterate that stays below the minimum over all elements folds
/// (replaces the backtracking for the lower bound epsilon of paper section 3.2).
template <class T>
T first_flip(const glm::mat<2, 2, T>& A, const glm::mat<2, 2, T>& B)
{
    using std::sqrt;
    const T infinity = T(std::numeric_limits<double>::infinity());
    const T zero = T(0.0);
    const T c = A[0][0] * A[1][1] - A[0][1] * A[1][0];
    const T b = A[0][0] * B[1][1] + B[0][0] * A[1][1] - A[0][1] * B[1][0] - B[0][1] * A[1][0];
    const T q = B[0][0] * B[1][1] - B[0][1] * B[1][0];
    const T discriminant = b * b - T(4.0) * q * c;
    const T root = sqrt(select(discriminant > zero, discriminant, zero));
    const T first = select(b > zero, (b + root) / (T(-2.0) * q), T(2.0) * c / (root - b));
    return select(discriminant >= zero, select(first > zero, first, infinity), infinity);
}

/// The same for a tetrahedron, or a little less: what is returned is never beyond the first root, and within 1e-3 of it
/// where it is simple and between 1e-6 and 1e6; what lies beyond 1e6 counts as never, and det that comes to 0 up to
/// rounding as a root.
///
/// det(A + a B) is a cubic p with p(0) > 0. Its critical points and the inflection between them cut [0, 1e6] into
/// pieces where it is monotone and does not change its curvature; the first piece that ends at or below 0 has the root.
/// It is narrowed by bisection of the exponent, and then from both sides: of Newton's step and the chord, one stays
/// before the root and one beyond it, whatever the curvature. Only the side before it is returned. A closed form would
/// need arc cosines, which devices do slowly, and lose the small roots to cancellation.
template <class T>
T first_flip(const glm::mat<3, 3, T>& A, const glm::mat<3, 3, T>& B)
{
    using std::abs, std::max, std::min, std::sqrt;
    const auto mixed = [](const auto& u, const auto& v, const auto& w) { return glm::dot(glm::cross(u, v), w); };
    const T zero = T(0.0), most = T(1048576.0), least = T(1.0 / 1048576.0);
    const T c0 = mixed(A[0], A[1], A[2]), c3 = mixed(B[0], B[1], B[2]);
    const T c1 = mixed(B[0], A[1], A[2]) + mixed(A[0], B[1], A[2]) + mixed(A[0], A[1], B[2]);
    const T c2 = mixed(A[0], B[1], B[2]) + mixed(B[0], A[1], B[2]) + mixed(B[0], B[1], A[2]);
    const auto p = [&](const T& a) { return ((c3 * a + c2) * a + c1) * a + c0; };
    // 0 up to rounding is 0: roots that nearly are double.
    const auto vanishes = [&](const T& a)
    { return p(a) <= T(4e-15) * (((abs(c3) * a + abs(c2)) * a + abs(c1)) * a + c0); };
    const auto slope = [&](const T& a) { return (T(3.0) * c3 * a + T(2.0) * c2) * a + c1; };
    const auto inside = [&](const T& a) { return select(a > zero, min(a, most), zero); }; // NaN becomes 0

    // Ends of the pieces, in ascending order: the roots of p', and the root of p'' between them.
    const T discriminant = c2 * c2 - T(3.0) * c1 * c3;
    const T root = sqrt(select(discriminant > zero, discriminant, zero));
    const T sum = select(c2 < zero, root - c2, -c2 - root);
    const T one = inside(sum / (T(3.0) * c3)), other = inside(c1 / sum), bend = inside(-c2 / (T(3.0) * c3));
    const auto turns = discriminant > zero;
    const T first = select(turns, min(one, other), bend), last = select(turns, max(one, other), bend);
    const T middle = min(max(bend, first), last);

    // The last piece that ends at or below 0 wins, looked at from the last to the first.
    T low = last, high = most;
    const auto never = !vanishes(most) && !vanishes(last) && !vanishes(middle) && !vanishes(first);
    const auto take = [&](const T& begin, const T& end)
    {
        const auto here = vanishes(end);
        low = select(here, begin, low);
        high = select(here, end, high);
    };
    take(middle, last);
    take(first, middle);
    take(zero, first);

    // The exponent first; what is below `least` is as good as linear.
    const auto try_at = [&](const T& a)
    {
        const auto before = !vanishes(a);
        const auto useful = (a > low) && (a < high);
        low = select(useful && before, a, low);
        high = select(useful && !before, a, high);
    };
    try_at(least);
    for (int k = 0; k < 6; ++k) try_at(sqrt(max(low, least) * high));
    for (int k = 0; k < 4; ++k)
    {
        const T at_low = p(low), at_high = p(high);
        const T chord = low + (high - low) * (at_low / (at_low - at_high));
        const T from_low = low - at_low / slope(low), from_high = high - at_high / slope(high);
        try_at(chord);
        try_at(low + (chord - low) * T(0.9995)); // where the chord meets the root itself, or rounds beyond it
        try_at(from_low);
        try_at(from_high);
    }
    return select(never, T(std::numeric_limits<double>::infinity()), low);
}

} // namespace taut::impl
