// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/mesh/first_flip.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The first root of det(A + a B) among finely spaced a in (0, most), refined by bisection; infinity if there is none.
template <int D>
double scanned(const mat<D>& A, const mat<D>& B, double most)
{
    const auto det = [&](double a) { return glm::determinant(A + a * B); };
    constexpr int steps = 40000;
    double before = 0;
    for (int k = 1; k <= steps; ++k)
    {
        // Finer near 0.
        const double t = double(k) / steps, a = most * t * t * t;
        if (det(a) <= 0)
        {
            double low = before, high = a;
            for (int n = 0; n < 200; ++n)
            {
                const double mid = (low + high) / 2;
                (det(mid) > 0 ? low : high) = mid;
            }
            return low;
        }
        before = a;
    }
    return infinity;
}

template <int D>
mat<D> random_matrix(std::mt19937& rng, double scale)
{
    mat<D> m;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) m[c][r] = scale * (double(rng()) / 2147483648.0 - 1);
    return m;
}

} // namespace

TEST_CASE("first flip: of a tetrahedron, never beyond the first root and close to it, for random directions")
{
    std::mt19937 rng(5);
    int found = 0, none = 0;
    for (int n = 0; n < 2000; ++n)
    {
        mat3 A = random_matrix<3>(rng, 1);
        if (glm::determinant(A) < 0) A[0] = -A[0];
        const double scale = std::pow(10.0, double(rng() % 7) - 3);
        const mat3 B = random_matrix<3>(rng, scale);
        const double expected = scanned<3>(A, B, 30 / scale);
        const double a = first_flip(A, B);
        CAPTURE(n);
        CAPTURE(expected);
        CAPTURE(a);
        if (expected == infinity)
        {
            CHECK(a >= 20 / scale);
            ++none;
            continue;
        }
        // A scan may miss two roots that nearly meet; then what is found lies before, where det is nearly 0.
        CHECK(a <= expected * (1 + 1e-9));
        if (a < expected * (1 - 1e-3))
            CHECK(std::abs(glm::determinant(A + a * 1.0005 * B)) < 2e-3 * glm::determinant(A));
        CHECK(glm::determinant(A + a * (1 - 1e-6) * B) > 0);
        ++found;
    }
    CHECK(found > 1000);
    CHECK(none > 100);
}

TEST_CASE("first flip: cubics with known roots")
{
    // diag(1 - a / r): roots at the three r.
    const auto at = [](double r0, double r1, double r2)
    {
        const auto inverse = [](double r) { return r == infinity ? 0.0 : -1 / r; };
        const mat3 B(inverse(r0), 0, 0, 0, inverse(r1), 0, 0, 0, inverse(r2));
        return first_flip(mat3(1.0), B);
    };
    const auto close = [](double a, double root) { return a <= root * (1 + 1e-12) && a > root * (1 - 1e-3); };
    CHECK(close(at(1, 2, 3), 1));
    CHECK(close(at(3, 0.5, 2), 0.5));
    CHECK(close(at(2, 2, 5), 2)); // double
    CHECK(at(2, 2, 2) <= 2 * (1 + 1e-5));
    CHECK(at(2, 2, 2) > 2 * (1 - 5e-2)); // triple
    CHECK(close(at(-1, -2, 4), 4));
    CHECK(close(at(-1, 0.25, infinity), 0.25));
    CHECK(close(at(infinity, infinity, 7), 7)); // linear
    CHECK(at(-1, -2, -3) == infinity);
    CHECK(at(infinity, infinity, infinity) == infinity); // no direction
    CHECK(close(at(1e-4, 1, 1e3), 1e-4));
    CHECK(close(at(1e5, 2e5, 3e5), 1e5));
    // Nearly linear: the leading coefficients are rounding.
    CHECK(close(at(1, 1e12, -1e12), 1));
    CHECK(close(at(1e-7, 1, 2), 1e-7));
}

TEST_CASE("first flip: a shear never flips, a turn flips at a quarter and in float as in double")
{
    CHECK(first_flip(mat3(1.0), mat3(0, 0, 0, 1, 0, 0, 0, 0, 0)) == infinity);
    // A + a B with B = -A: everything shrinks to a point at a = 1.
    const mat3 A(2, 0.1, 0, 0, 1, 0.3, 0.2, 0, 3);
    CHECK(first_flip(A, -A) <= 1);
    CHECK(first_flip(A, -A) > 0.95);
    const glm::mat<3, 3, float> Af(A), Bf(mat3(-1, 0.2, 0, 0, 0.5, 0, 0.1, 0, 0.25));
    CHECK(double(first_flip(Af, Bf)) == doctest::Approx(first_flip(A, mat3(Bf))).epsilon(1e-2));
}
