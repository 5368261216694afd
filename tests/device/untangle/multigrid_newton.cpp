// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/size.hpp>

#include <support/regularized_sum.hpp>
#include <support/shared_context.hpp>
#include <taut/impl/core/untangle/device/multigrid_newton.hpp>
#include <taut/impl/core/untangle/element_newton.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/impl/core/untangle/untangle_on_device.hpp>
#include <taut/untangle.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A square or cube of which the rim is held and the inside is somewhere.
template <class Element>
untangle_problem<Element> scrambled(int n)
{
    constexpr int D = Element::dimension;
    auto m = [n]
    {
        if constexpr (D == 2)
            return test::grid(n, n);
        else
            return test::cube(n);
    }();
    untangle_problem<Element> p{std::move(m), {}, fixed_marks<D>()};
    p.held = fixed_marks<D>(p.rest.points().size());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(0.1, 0.9);
    for (const vec3& point : p.rest.points())
    {
        vec<D> x;
        for (int k = 0; k < D; ++k) x[k] = point[k];
        const bool rim = glm::any(glm::equal(x, vec<D>(0.0))) || glm::any(glm::equal(x, vec<D>(1.0)));
        if (rim)
            p.held[p.initial.size()] = p.held.every;
        else
            for (int k = 0; k < D; ++k) x[k] = at(random);
        p.initial.push_back(x);
    }
    return p;
}

/// A frame between two squares of which the inner one is turned, so that the harmonic map is not enough.
untangle_problem<triangle> turned_frame(int n, double angle)
{
    auto m = test::grid(n, n);
    untangle_problem<triangle> p{std::move(m), {}, fixed_marks<2>()};
    p.held = fixed_marks<2>(p.rest.points().size());
    for (const vec3& point : p.rest.points())
    {
        const vec2 x(point.x - 0.5, point.y - 0.5);
        const double size = std::max(std::abs(x.x), std::abs(x.y));
        const bool inner = size < 0.2;
        const double turn = inner ? angle : 0.0, c = std::cos(turn), s = std::sin(turn);
        if (inner || size > 0.5 - 1e-9) p.held[p.initial.size()] = p.held.every;
        p.initial.emplace_back(c * x.x - s * x.y, s * x.x + c * x.y);
    }
    return p;
}

template <class Element>
regularized_problem<Element> towards_rest(const untangle_problem<Element>& p)
{
    return {.rest = p.rest,
            .held = p.held,
            .shapes = impl::rest_shapes(p.rest, impl::expected_measure(p, p.initial)),
            .area_weight = 0.7};
}

template <class Element>
std::vector<std::string> defects_of_held(const untangle_problem<Element>& p,
                                         const std::vector<vec<Element::dimension>>& x)
{
    std::vector<std::string> moved;
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < Element::dimension; ++k)
            if (p.held.test(v, k) && x[v][k] != p.initial[v][k]) moved.push_back(std::to_string(v));
    return moved;
}

} // namespace

TEST_CASE_TEMPLATE("multigrid_newton: its energy is that of the host, and other eps take no other kernel", Element,
                   triangle, tetrahedron)
{
    constexpr int D = Element::dimension;
    queue q(test::shared_context());
    const auto p = scrambled<Element>(test::sized(D == 2 ? 20 : 5, 3));
    multigrid_newton<Element> newton(q, multigrid_newton<Element>::trace(q), towards_rest(p));
    impl::regularized_sum<Element> host(p.rest, p.held);
    host.shapes = towards_rest(p).shapes;
    host.area_weight = 0.7;
    std::vector<double> flat, gradient(D * p.initial.size());
    for (const auto& x : p.initial)
        for (int k = 0; k < D; ++k) flat.push_back(x[k]);
    newton.value(p.initial);
    const auto builds = q.counters().builds;
    for (const double eps : {10.0, 1.0, 1e-2, 1e-4})
    {
        CAPTURE(eps);
        newton.eps = host.eps = eps;
        CHECK(newton.value(p.initial) == doctest::Approx(host.value_gradient(flat, gradient)).epsilon(1e-10));
        CHECK(newton.least_det(p.initial) == doctest::Approx(host.least_det(flat)));
    }
    CHECK(q.counters().builds == builds);
}

TEST_CASE_TEMPLATE("multigrid_newton: steps lower the energy and leave what is held, single coordinates too", Element,
                   triangle, tetrahedron)
{
    queue q(test::shared_context());
    auto p = scrambled<Element>(test::sized(Element::dimension == 2 ? 20 : 5, 3));
    for (std::size_t v = 0; v < p.held.size(); v += 3) p.held[v] |= 1; // one coordinate of some inside
    multigrid_newton<Element> newton(q, multigrid_newton<Element>::trace(q), towards_rest(p));
    newton.eps = 1;
    auto x = p.initial;
    double here = newton.value(x);
    for (int i = 0; i < 5; ++i)
    {
        const double there = newton.step(x, here);
        CHECK(there < here);
        CHECK(newton.last_length() > 0);
        CHECK(newton.value(x) == doctest::Approx(there));
        here = there;
    }
    CHECK(defects_of_held(p, x).empty());
}

TEST_CASE("multigrid_newton: converges to what the direct solver does, with springs of other stiffness a coordinate")
{
    queue q(test::shared_context());
    const auto p = turned_frame(test::sized(24, 10), 0.3);
    auto problem = towards_rest(p);
    const auto inside = static_cast<idx>(p.initial.size() / 2 + 4);
    problem.springs = {{2 * inside / 3, {0.1, -0.3}, {5.0, 0.0}}, {inside, {0.2, 0.1}, {1.0, 30.0}}};
    multigrid_newton<triangle> device(q, multigrid_newton<triangle>::trace(q), problem);
    impl::triangle_newton host(problem);
    const auto minimum = [&](regularized_newton<triangle>& newton)
    {
        newton.eps = 0.5;
        for (auto& s : newton.springs) s.target *= 0.5;
        auto x = p.initial;
        double here = newton.value(x);
        for (int i = 0; i < 40; ++i) here = newton.step(x, here);
        return here;
    };
    CHECK(minimum(device) == doctest::Approx(minimum(host)).epsilon(1e-9));
}

TEST_CASE("multigrid_newton: a barrier keeps positive what is")
{
    queue q(test::shared_context());
    auto p = scrambled<triangle>(12);
    p.initial = impl::harmonic_start(p, p.initial);
    for (std::size_t v = 0; v < p.held.size(); v += 2)
        if (!p.held.any(v)) p.initial[v] += vec2(0.02, 0.01);
    multigrid_newton<triangle> newton(q, multigrid_newton<triangle>::trace(q), towards_rest(p));
    auto x = p.initial;
    double here = newton.value(x);
    REQUIRE(std::isfinite(here));
    for (int i = 0; i < 5; ++i) here = newton.step(x, here);
    CHECK(newton.least_det(x) > 0);
    CHECK(here < newton.value(p.initial));
}

TEST_CASE("newton stage: solves on the device what the harmonic map does not")
{
    queue q(test::shared_context());
    SUBCASE("in the plane")
    {
        const auto p = turned_frame(test::sized(60, 60), 1.2); // above the size that goes to the host
        const auto r = untangle(q, p, {.stages = {"newton"}});
        CHECK(r);
        CHECK(r.stage == "newton");
        CHECK(defects_of_held(p, r.map).empty());
        CHECK(q.counters().launches > 0);
    }
    SUBCASE("in space")
    {
        const auto p = scrambled<tetrahedron>(test::sized(6, 3));
        const auto r = untangle(q, p, {.stages = {"newton"}});
        CHECK(r);
        CHECK(defects_of_held(p, r.map).empty());
    }
}

TEST_CASE("multigrid_newton: flat triangles at rest")
{
    queue q(test::shared_context());
    auto p = scrambled<triangle>(10);
    auto points = p.rest.points();
    points[60] = points[61];
    p.rest = {points, p.rest.cells()};
    multigrid_newton<triangle> newton(q, multigrid_newton<triangle>::trace(q), towards_rest(p));
    newton.eps = 1;
    auto x = p.initial;
    const double here = newton.value(x);
    CHECK(newton.step(x, here) < here);
}
