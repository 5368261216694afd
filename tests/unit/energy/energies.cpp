// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include <doctest/doctest.h>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/energy/corner_derivatives.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using namespace taut::energy;

template <int D>
element<double, D> at(const mat<D>& S)
{
    return {S, glm::determinant(S), 1.0};
}

template <int D>
mat<D> random_matrix(std::mt19937& rng, double spread)
{
    std::uniform_real_distribution<double> u(-spread, spread);
    mat<D> m(1.0);
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) m[c][r] += u(rng);
    return m;
}

/// Gram-Schmidt of a random matrix, determinant +1.
template <int D>
mat<D> random_rotation(std::mt19937& rng)
{
    mat<D> q = random_matrix<D>(rng, 2.0);
    for (int c = 0; c < D; ++c)
    {
        for (int k = 0; k < c; ++k) q[c] -= glm::dot(q[c], q[k]) * q[k];
        q[c] /= std::sqrt(glm::dot(q[c], q[c]));
    }
    if (glm::determinant(q) < 0) q[0] = -q[0];
    return q;
}

template <class Energy, int D_>
struct with
{
    using energy_type = Energy;
    static constexpr int D = D_;
};

} // namespace

TYPE_TO_STRING(with<shape, 2>);
TYPE_TO_STRING(with<shape, 3>);
TYPE_TO_STRING(with<area, 2>);
TYPE_TO_STRING(with<area, 3>);
TYPE_TO_STRING(with<isometric, 2>);
TYPE_TO_STRING(with<isometric, 3>);

#define TEST_EVERY_ENERGY                                                                                              \
    with<shape, 2>, with<shape, 3>, with<area, 2>, with<area, 3>, with<isometric, 2>, with<isometric, 3>

TEST_CASE_TEMPLATE("energy: a rotation is the minimum", C, TEST_EVERY_ENERGY)
{
    constexpr int D = C::D;
    typename C::energy_type e;
    std::mt19937 rng(7);
    const double rest = rest_value<D>(e);
    for (int trial = 0; trial < 2000; ++trial)
    {
        CHECK(e(at<D>(random_rotation<D>(rng))) == doctest::Approx(rest).epsilon(1e-12));
        const auto x = at<D>(random_matrix<D>(rng, 0.9));
        if (x.det > 1e-3) CHECK(e(x) >= rest * (1 - 1e-12));
    }
    // Dilations near 1 too: eq. 19 taken literally in 3D has its minimum at one of them.
    for (double s = 0.8; s < 1.3; s += 0.01) CHECK(e(at<D>(mat<D>(s))) >= rest * (1 - 1e-12));
}

TEST_CASE_TEMPLATE("energy: rotating before or after the map changes nothing", C, TEST_EVERY_ENERGY)
{
    constexpr int D = C::D;
    typename C::energy_type e;
    std::mt19937 rng(11);
    for (int trial = 0; trial < 500; ++trial)
    {
        const mat<D> S = random_matrix<D>(rng, 0.4);
        const mat<D> Q = random_rotation<D>(rng), R = random_rotation<D>(rng);
        if (glm::determinant(S) < 0.05) continue;
        CHECK(e(at<D>(Q * S * R)) == doctest::Approx(e(at<D>(S))).epsilon(1e-10));
    }
}

TEST_CASE("energy: known values in the plane")
{
    const auto stretch = at<2>(mat2(2.0, 0.0, 0.0, 1.0));
    CHECK(shape{}(stretch) == doctest::Approx(1.25));
    CHECK(area{}(stretch) == doctest::Approx(2.5));
    CHECK(isometric{}(stretch) == doctest::Approx(5 * 1.25));
    CHECK(rest_value<2>(isometric{}) == 4.0);
}

TEST_CASE("energy: in the plane isometric is twice shape times area, eqs. 4, 18 and 19")
{
    std::mt19937 rng(3);
    for (int trial = 0; trial < 500; ++trial)
    {
        const auto x = at<2>(random_matrix<2>(rng, 0.9));
        if (x.det > 1e-3) CHECK(isometric{}(x) == doctest::Approx(2 * shape{}(x)*area{}(x)).epsilon(1e-12));
    }
}

TEST_CASE("energy: shape does not see scale, area does not see shear")
{
    CHECK(shape{}(at<3>(mat3(5.0))) == doctest::Approx(1.0));
    CHECK(shape{}(at<2>(mat2(0.01))) == doctest::Approx(1.0));
    mat2 shear(1.0);
    shear[1][0] = 7;
    CHECK(area{}(at<2>(shear)) == doctest::Approx(2.0));
}

TEST_CASE("algebra: sums, factors and products evaluate as written")
{
    std::mt19937 rng(5);
    const auto mixed = 0.8 * isometric{} + shape{} * 0.2 + shape{} * area{};
    for (int trial = 0; trial < 200; ++trial)
    {
        const auto x = at<2>(random_matrix<2>(rng, 0.4));
        if (x.det < 0.05) continue;
        CHECK(mixed(x) ==
              doctest::Approx(0.8 * isometric{}(x) + 0.2 * shape{}(x) + shape{}(x)*area{}(x)).epsilon(1e-14));
    }
    static_assert(decltype(mixed)::barrier);
}

TEST_CASE("isometric: its derivatives by the invariants are those of its value")
{
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> some(-0.4, 0.4);
    const auto value = [](const mat2& S) {
        return energy::isometric{}(element<double, 2>{S, glm::determinant(S), 1.0});
    };
    const auto psi = [](const mat2& S) { return energy::isometric::derivatives(norm2(S), glm::determinant(S)); };
    const auto gradient = [&](const mat2& S) { return gradient_by_shape(S, psi(S).by_I, psi(S).by_d); };
    for (int n = 0; n < 20; ++n)
    {
        const mat2 S(1 + some(rng), some(rng), some(rng), 1 + some(rng));
        const auto H = plane_modes<double>(S, psi(S), {.projected = false}).hessian(1.0);
        const double h = 1e-6;
        for (int i = 0; i < 4; ++i)
        {
            mat2 ahead = S, behind = S;
            ahead[i / 2][i % 2] += h;
            behind[i / 2][i % 2] -= h;
            CHECK(gradient(S)[i / 2][i % 2] ==
                  doctest::Approx((value(ahead) - value(behind)) / (2 * h)).epsilon(1e-6).scale(10));
            const mat2 change = (gradient(ahead) - gradient(behind)) / (2 * h);
            for (int j = 0; j < 4; ++j)
                CHECK(H(i, j) == doctest::Approx(change[j / 2][j % 2]).epsilon(1e-6).scale(100));
        }
    }
}

TEST_CASE_TEMPLATE("corner derivatives: they are those of a quadratic of S", Element, triangle, tetrahedron)
{
    constexpr int D = Element::dimension;
    constexpr std::size_t N = Element::corners;
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> some(-1, 1);
    mat<D> inverse(0.0);
    for (int c = 0; c < D; ++c)
        for (int r = 0; r <= c; ++r) inverse[c][r] = some(rng);
    symmetric_matrix<double, D * D> H;
    for (int j = 0; j < D * D; ++j)
        for (int i = 0; i <= j; ++i) H(i, j) = some(rng);
    const auto gradient = [&](const std::array<vec<D>, N>& x)
    {
        mat<D> A;
        for (int k = 0; k < D; ++k) A[k] = x[static_cast<std::size_t>(k) + 1] - x[0];
        const mat<D> S = shape_matrix(A, inverse);
        mat<D> g(0.0);
        for (int i = 0; i < D * D; ++i)
            for (int j = 0; j < D * D; ++j) g[i / D][i % D] += H(i, j) * S[j / D][j % D];
        return corner_gradient<D>(g, inverse);
    };
    std::array<vec<D>, N> x;
    for (auto& p : x)
        for (int k = 0; k < D; ++k) p[k] = some(rng);
    const auto blocks = corner_hessian<D>(H, inverse);
    const auto here = gradient(x);
    vec<D> sum(0.0);
    for (const auto& g : here) sum += g;
    for (int k = 0; k < D; ++k) CHECK(std::abs(sum[k]) < 1e-14);
    for (std::size_t i = 0; i < D * N; ++i)
    {
        auto moved = x;
        moved[i / D][static_cast<int>(i % D)] += 1; // the gradient is linear
        const auto there = gradient(moved);
        for (std::size_t j = 0; j < D * N; ++j)
        {
            const int r = static_cast<int>(j % D);
            CHECK(blocks[i][j] == doctest::Approx(there[j / D][r] - here[j / D][r]).epsilon(1e-12).scale(10));
        }
    }
}
