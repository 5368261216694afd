// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <support/regularized_sum.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/impl/core/untangle/epsilon_schedule.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

double entry(const mat2& S, std::size_t i)
{
    return S[static_cast<int>(i / 2)][static_cast<int>(i % 2)];
}

mat2 moved(mat2 S, std::size_t i, double by)
{
    S[static_cast<int>(i / 2)][static_cast<int>(i % 2)] += by;
    return S;
}

mat2 random_matrix(std::mt19937& random)
{
    std::uniform_real_distribution<double> at(-1.5, 1.5);
    return {at(random), at(random), at(random), at(random)};
}

} // namespace

TEST_CASE("regularized energy: chi is positive for every determinant and tends to it")
{
    const auto chi = [](double eps, double det) { return energy::impl::regularized<2>{.eps = eps}.chi(det); };
    for (const double det : {-1e8, -1.0, -1e-9, 0.0, 1e-9, 1.0})
        for (const double eps : {1e-6, 1e-2, 1.0}) CHECK(chi(eps, det) > 0);
    CHECK(chi(1e-12, 2.0) == doctest::Approx(2.0));
    CHECK(chi(1e-3, -1e3) == doctest::Approx(2.5e-10)); // eps^2 / (4 |det|), not a difference
}

TEST_CASE("regularized energy: without eps it is a barrier, with it inverted triangles have a value")
{
    const mat2 inverted(-1.0, 0.0, 0.0, 1.0);
    CHECK(energy::impl::regularized<2>{0, 1}(inverted) == std::numeric_limits<double>::infinity());
    CHECK(std::isfinite(energy::impl::regularized<2>{0.1, 1}(inverted)));
    CHECK(energy::impl::regularized<2>{0, 1}(mat2(1.0)) == doctest::Approx(4.0)); // |S|^2 + det + 1 / det
}

TEST_CASE("regularized energy: the derivatives are those of the value, inverted triangles included")
{
    std::mt19937 random(1);
    const energy::impl::regularized<2> f{0.3, 0.7};
    const double h = 1e-6;
    const auto gradient = [&](const mat2& S)
    {
        const auto psi = f.derivatives(norm2(S), glm::determinant(S));
        return gradient_by_shape(S, psi.by_I, psi.by_d);
    };
    int convex = 0;
    for (int n = 0; n < 200; ++n)
    {
        const mat2 S = random_matrix(random);
        const auto first = f.first_derivatives(norm2(S), glm::determinant(S));
        const auto psi = f.derivatives(norm2(S), glm::determinant(S));
        CHECK(first.value == doctest::Approx(f(S)));
        CHECK(first.by_I == doctest::Approx(psi.by_I));
        CHECK(first.by_d == doctest::Approx(psi.by_d));
        const mat2 g = gradient(S);
        const auto exact = plane_modes<double>(S, psi, {.projected = false}).hessian(1);
        const auto projected = plane_modes<double>(S, psi, {}).hessian(1);
        bool clamped = false;
        for (int i = 0; i < 4; ++i)
        {
            const auto at = static_cast<std::size_t>(i);
            const double slope = (f(moved(S, at, h)) - f(moved(S, at, -h))) / (2 * h);
            CHECK(entry(g, at) == doctest::Approx(slope).epsilon(1e-5).scale(1));
            const mat2 ahead = gradient(moved(S, at, h)), behind = gradient(moved(S, at, -h));
            const double size = std::abs(f(S)) + 1;
            for (int j = 0; j < 4; ++j)
            {
                const auto to = static_cast<std::size_t>(j);
                CHECK(exact(i, j) ==
                      doctest::Approx((entry(ahead, to) - entry(behind, to)) / (2 * h)).epsilon(1e-4).scale(size));
                clamped = clamped || std::abs(exact(i, j) - projected(i, j)) > 1e-9 * size;
            }
            CHECK(projected(i, i) >= exact(i, i) - 1e-9 * size);
        }
        convex += !clamped;
    }
    CHECK(convex > 10);
    CHECK(convex < 190);
}

TEST_CASE_TEMPLATE("regularized energy: the sum over a mesh has the gradient of its value", Element, triangle,
                   tetrahedron)
{
    constexpr int D = Element::dimension;
    std::vector<vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4, 0.3, 1}};
    std::vector<typename mesh<Element>::cell> cells;
    if constexpr (D == 2)
        cells = {{0, 1, 2}, {1, 3, 2}};
    else
        cells = {{0, 1, 2, 3}};
    const mesh<Element> m(points, cells);
    const fixed_marks<D> held(std::vector<std::uint8_t>{1, 0, 0, 0});
    impl::regularized_sum<Element> f(m, held);
    f.eps = 0.2;
    f.shapes = impl::rest_shapes(m, 1.0);

    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(-1, 1);
    std::vector<double> x(points.size() * D), g(x.size()), ignored(x.size());
    for (double& c : x) c = at(random);
    f.value_gradient(x, g);
    CHECK(g[0] == 0); // held
    const double h = 1e-6;
    for (std::size_t i = 1; i < x.size(); ++i)
    {
        auto ahead = x, behind = x;
        ahead[i] += h;
        behind[i] -= h;
        const double slope = (f.value_gradient(ahead, ignored) - f.value_gradient(behind, ignored)) / (2 * h);
        CHECK(g[i] == doctest::Approx(slope).epsilon(1e-4).scale(1));
    }
}

TEST_CASE("epsilon schedule: it falls while steps are full, hardly while they are cut, and starts again")
{
    impl::epsilon_schedule full(-1.0), cut(-1.0);
    for (int i = 0; i < 10; ++i)
    {
        full.lower(1.0, 0.99, 1.0, -0.5);
        cut.lower(1.0, 0.9999, 1e-6, -0.5);
    }
    CHECK(full.eps() < 0.5 * cut.eps());
    double least = full.eps(), largest = 0;
    for (int i = 0; i < 60; ++i)
    {
        full.lower(1.0, 0.99, 1.0, -1e-9);
        if (full.eps() > 10 * least) largest = std::max(largest, full.eps());
        least = std::min(least, full.eps());
    }
    CHECK(largest >= 0.01);
}
