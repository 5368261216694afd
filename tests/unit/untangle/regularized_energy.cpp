// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <taut/untangle/epsilon_schedule.hpp>
#include <taut/untangle/regularized_sum.hpp>

namespace
{

using namespace taut;
using detail::regularized_triangle;

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
    for (const double det : {-1e8, -1.0, -1e-9, 0.0, 1e-9, 1.0})
        for (const double eps : {1e-6, 1e-2, 1.0}) CHECK(regularized_triangle::chi(eps, det) > 0);
    CHECK(regularized_triangle::chi(1e-12, 2.0) == doctest::Approx(2.0));
    CHECK(regularized_triangle::chi(1e-3, -1e3) == doctest::Approx(2.5e-10)); // eps^2 / (4 |det|), not a difference
}

TEST_CASE("regularized energy: without eps it is a barrier, with it inverted triangles have a value")
{
    const mat2 inverted(-1.0, 0.0, 0.0, 1.0);
    CHECK(regularized_triangle::value_of(inverted, 0, 1) == std::numeric_limits<double>::infinity());
    CHECK(std::isfinite(regularized_triangle::value_of(inverted, 0.1, 1)));
    CHECK(regularized_triangle::value_of(mat2(1.0), 0, 1) == doctest::Approx(4.0)); // |S|^2 + det + 1 / det
}

TEST_CASE("regularized energy: the gradient is that of the value, inverted triangles included")
{
    std::mt19937 random(1);
    const double h = 1e-6;
    for (int n = 0; n < 50; ++n)
    {
        const mat2 S = random_matrix(random);
        const regularized_triangle f(S, 0.3, 0.7);
        CHECK(f.value == doctest::Approx(regularized_triangle::value_of(S, 0.3, 0.7)));
        for (std::size_t i = 0; i < 4; ++i)
        {
            const double slope = (regularized_triangle::value_of(moved(S, i, h), 0.3, 0.7) -
                                  regularized_triangle::value_of(moved(S, i, -h), 0.3, 0.7)) /
                                 (2 * h);
            CHECK(f.gradient[i] == doctest::Approx(slope).epsilon(1e-5));
        }
    }
}

TEST_CASE("regularized energy: the Hessian is that of the gradient where nothing was clamped, and never less")
{
    std::mt19937 random(2);
    const double h = 1e-6;
    int convex = 0;
    for (int n = 0; n < 200; ++n)
    {
        const mat2 S = random_matrix(random);
        const regularized_triangle f(S, 0.5, 1);
        const bool clamped = std::any_of(f.stiffness.begin(), f.stiffness.end(), [](double s) { return s == 0; });
        convex += !clamped;
        for (std::size_t i = 0; i < 4; ++i)
        {
            const regularized_triangle ahead(moved(S, i, h), 0.5, 1), behind(moved(S, i, -h), 0.5, 1);
            for (std::size_t j = 0; j < 4; ++j)
            {
                double model = 0;
                for (std::size_t m = 0; m < 4; ++m) model += f.stiffness[m] * f.modes[m][i] * f.modes[m][j];
                const double exact = (ahead.gradient[j] - behind.gradient[j]) / (2 * h);
                if (!clamped)
                    CHECK(model == doctest::Approx(exact).epsilon(1e-4).scale(std::abs(f.value) + 1));
                else if (i == j)
                    CHECK(model >= exact - 1e-4 * (std::abs(f.value) + 1));
            }
        }
    }
    CHECK(convex > 10);
    CHECK(entry(mat2(1, 2, 3, 4), 2) == 3);
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
    const held_marks<D> held(std::vector<std::uint8_t>{1, 0, 0, 0});
    detail::regularized_sum<Element> f(m, held);
    f.eps = 0.2;
    f.shapes = detail::rest_shapes(m, 1.0);

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
    detail::epsilon_schedule full(-1.0), cut(-1.0);
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
