// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>

#include <taut/energies.hpp>
#include <taut/evaluator.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

template <class Element>
mesh<Element> sample()
{
    if constexpr (Element::dimension == 2)
        return test::bumpy(5, 0.3, 2);
    else
        return test::cube(2);
}

/// A map near the mesh itself, in other units.
template <class Element>
std::vector<vec<Element::dimension>> near_rest(const mesh<Element>& m, unsigned seed)
{
    std::mt19937 rng(seed);
    std::vector<vec<Element::dimension>> x;
    for (const vec3& p : m.points())
    {
        auto& q = x.emplace_back();
        for (int k = 0; k < Element::dimension; ++k) q[k] = 1.2 * p[k] + 0.02 * (double(rng()) / 4294967296.0);
    }
    return x;
}

} // namespace

TEST_CASE_TEMPLATE("map evaluator: the gradient is that of the values, and the Hessian that of the gradients", Element,
                   triangle, tetrahedron)
{
    constexpr int D = Element::dimension;
    const auto m = sample<Element>();
    queue q(test::shared_context());
    map_evaluator<Element> f(q, m, energy::isometric{});
    const auto x = near_rest<Element>(m, 1);
    const std::size_t n = x.size();
    std::vector<vec<D>> g(n), left(n), right(n);
    const double value = f.value_gradient(x, g);
    CHECK(value == doctest::Approx(f.value(x)).epsilon(1e-14));
    const auto H = f.hessian(x);
    REQUIRE(H.offsets.size() == n + 1);

    std::mt19937 rng(7);
    for (int trial = 0; trial < 3; ++trial)
    {
        auto forward = x, backward = x;
        std::vector<vec<D>> d(n);
        const double h = 1e-5;
        double slope = 0;
        for (std::size_t v = 0; v < n; ++v)
            for (int k = 0; k < D; ++k)
            {
                d[v][k] = double(rng()) / 4294967296.0 - 0.5;
                forward[v][k] += h * d[v][k];
                backward[v][k] -= h * d[v][k];
                slope += d[v][k] * g[v][k];
            }
        const double rise = f.value_gradient(forward, right) - f.value_gradient(backward, left);
        CHECK(slope == doctest::Approx(rise / (2 * h)).epsilon(1e-6));
        double worst = 0, largest = 0;
        for (std::size_t v = 0; v < n; ++v)
        {
            vec<D> product(0.0);
            for (auto k = static_cast<std::size_t>(H.offsets[v]); k < static_cast<std::size_t>(H.offsets[v + 1]); ++k)
                product += H.blocks[k] * d[static_cast<std::size_t>(H.columns[k])];
            const vec<D> expected = (right[v] - left[v]) / (2 * h);
            worst = std::max(worst, glm::length(product - expected));
            largest = std::max(largest, glm::length(expected));
        }
        CHECK(worst <= 1e-6 * largest);
    }
}

TEST_CASE("map evaluator: steps up to max_step stay inside, and beyond it the value is infinite")
{
    const auto m = sample<triangle>();
    queue q(test::shared_context());
    map_evaluator<triangle> f(q, m, energy::isometric{});
    auto x = near_rest<triangle>(m, 1);
    std::vector<vec2> d(x.size(), vec2(0));
    d[m.points().size() / 2] = {1, 0.3};
    const double a = f.max_step(x, d);
    REQUIRE(std::isfinite(a));
    auto moved = x;
    const auto at = [&](double t)
    {
        for (std::size_t v = 0; v < x.size(); ++v) moved[v] = x[v] + t * d[v];
        return f.value(moved);
    };
    CHECK(std::isfinite(at(0.999 * a)));
    CHECK(std::isinf(at(1.001 * a)));
    CHECK_THROWS_AS(f.value(std::span<const vec2>(x).first(3)), parameter_error);
    CHECK_THROWS_AS(f.value_gradient(x, std::span<vec2>(d).first(3)), parameter_error);
}

TEST_CASE("map evaluator: the projected Hessian is positive semi-definite where the other one is not")
{
    const auto m = sample<triangle>();
    queue q(test::shared_context());
    map_evaluator<triangle> f(q, m, energy::isometric{});
    auto x = near_rest<triangle>(m, 1);
    for (vec2& p : x) p *= 3.0; // stretched: indefinite
    const auto lowest = [&](const block_rows<2>& H)
    {
        double least = 0;
        std::mt19937 rng(3);
        for (int trial = 0; trial < 200; ++trial)
        {
            std::vector<vec2> d(x.size());
            for (vec2& v : d) v = {double(rng()) / 2147483648.0 - 1, double(rng()) / 2147483648.0 - 1};
            if (trial == 0) // a turn
                for (std::size_t v = 0; v < x.size(); ++v) d[v] = {-x[v].y, x[v].x};
            double sum = 0, square = 0;
            for (std::size_t v = 0; v < x.size(); ++v)
            {
                square += glm::dot(d[v], d[v]);
                for (auto k = static_cast<std::size_t>(H.offsets[v]); k < static_cast<std::size_t>(H.offsets[v + 1]);
                     ++k)
                    sum += glm::dot(d[v], H.blocks[k] * d[static_cast<std::size_t>(H.columns[k])]);
            }
            least = std::min(least, sum / square);
        }
        return least;
    };
    for (vec2& p : x) p /= 6.0; // shrunk: a turn lowers the quadratic model
    CHECK(lowest(f.hessian(x)) < -1e-3);
    CHECK(lowest(f.hessian(x, definiteness::projected)) > -1e-9);
}
