// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/mips_power.hpp>
#include <support/objective_cases.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::arithmetic, test::energies, test::largest, test::named_energy;

/// A curved surface with its levels, and a start that is distorted but not folded, in the order of level 0.
struct levels_fixture
{
    mesh<triangle> surface;
    std::vector<bool> pinned;
    mesh_levels<triangle> levels;
    std::vector<vec2> start;
    queue q{test::shared_context()};

    explicit levels_fixture(mesh<triangle> m, bool pin_some = false)
        : surface(std::move(m)),
          pinned(pins(surface, pin_some)),
          levels(surface, pinned),
          start(levels.order().vertices.apply(barycentric_map(surface).uv))
    {
    }

    static std::vector<bool> pins(const mesh<triangle>& m, bool some)
    {
        std::vector<bool> flags;
        for (taut::idx v = 0; some && v < m.vertex_count(); ++v) flags.push_back(v % 3 == 0);
        return flags;
    }

    newton_objective<triangle> make(const any_energy& energy, const real_types& types = {}) const
    {
        return {q,
                {levels, 0, lane_form::for_device(q.device())},
                energy,
                energy::weighting::measure,
                std::make_shared<const newton_kernels<triangle>>(q, energy, types)};
    }
};

mesh<triangle> hills()
{
    return test::bumpy(test::sized(14, 3), 0.4, 5);
}

/// A random vector that is zero where the gradient is.
std::vector<double> random_vector(const newton_objective<triangle>& f, std::mt19937& random)
{
    std::normal_distribution<double> normal;
    const auto& l = f.layout();
    std::vector<double> v(2 * l.vertex_stride, 0.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(l.free_count); ++i)
        for (std::size_t r = 0; r < 2; ++r) v[r * l.vertex_stride + i] = normal(random);
    return v;
}

} // namespace

TEST_CASE_TEMPLATE("newton objective: products with the Hessian are differences of gradients", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    for (const bool pin_some : {false, true})
    {
        const levels_fixture s(hills(), pin_some);
        for (const named_energy& tried : energies())
        {
            CAPTURE(tried.name);
            CAPTURE(pin_some);
            auto f = s.make(tried.energy, A::types());
            auto reference = s.make(tried.energy);
            auto x = f.make_point();
            f.upload(s.start, x);
            auto y = reference.make_point(), moved = reference.make_point();
            reference.upload(s.start, y);
            auto v = f.space().make(), product = f.space().make();
            auto d = reference.space().make(), up = reference.space().make(), down = reference.space().make();
            std::mt19937 random(7);
            f.linearize(x, true);
            for (int trial = 0; trial < 3; ++trial)
            {
                const auto direction = random_vector(f, random);
                v.upload(direction);
                f.hessian_product(v, product);

                d.upload(direction);
                auto back = direction;
                for (double& b : back) b = -b;
                up.upload(back);
                const double h = 1e-4 * std::min(reference.max_step(y, d), reference.max_step(y, up));
                reference.step(y, h, d, moved);
                reference.gradient(moved, up);
                reference.step(y, -h, d, moved);
                reference.gradient(moved, down);
                const auto plus = up.download(), minus = down.download();
                const auto found = product.download();
                std::vector<double> expected(plus.size()), error(plus.size());
                for (std::size_t i = 0; i < plus.size(); ++i)
                {
                    expected[i] = (plus[i] - minus[i]) / (2 * h);
                    error[i] = found[i] - expected[i];
                }
                CHECK(largest(error) < (A::wide ? 1e-6 : 2e-4) * largest(expected));
                if (pin_some)
                    for (auto i = static_cast<std::size_t>(f.layout().free_count); i < f.layout().vertex_stride; ++i)
                        CHECK(found[i] == 0);
            }
        }
    }
}

TEST_CASE_TEMPLATE(
    "newton objective: the stand-in of the Hessian is symmetric, positive semi-definite and not below it", A,
    arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    for (const bool pin_some : {false, true})
    {
        const levels_fixture s(hills(), pin_some);
        for (const named_energy& tried : energies())
        {
            CAPTURE(tried.name);
            CAPTURE(pin_some);
            auto f = s.make(tried.energy, A::types());
            auto x = f.make_point();
            f.upload(s.start, x);
            const auto& space = f.space();
            auto v = space.make(), w = space.make(), Av = space.make(), Aw = space.make();
            std::mt19937 random(11);
            double norm = 0, most = 0; // of the matrix, at least; v'(A - H)v of a unit vector v, at most
            for (int trial = 0; trial < 12; ++trial)
            {
                v.upload(random_vector(f, random));
                w.upload(random_vector(f, random));
                f.linearize(x, false);
                f.hessian_product(w, Aw);
                norm = std::max(norm, std::sqrt(space.dot(Aw, Aw) / space.dot(w, w)));
                // Smooth vectors, too: those that the matrix makes small.
                for (int k = 0; k < trial % 4; ++k)
                {
                    f.precondition(v, Av);
                    space.axpby(1 / std::sqrt(space.dot(Av, Av)), Av, 0, v);
                }
                f.hessian_product(v, Av);
                const double vv = space.dot(v, v), rounding = (A::wide ? 1e-12 : 1e-4) * norm;
                const double upper = space.dot(v, Av);
                CHECK(upper >= -rounding * vv);
                CHECK(std::abs(space.dot(w, Av) - space.dot(v, Aw)) <= rounding * std::sqrt(vv * space.dot(w, w)));

                f.linearize(x, true);
                f.hessian_product(v, Aw);
                const double exact = space.dot(v, Aw);
                CHECK(upper >= exact - rounding * vv);
                most = std::max(most, (upper - exact) / vv);
            }
            CHECK(most > 1e-5 * norm); // this far from the minimum the Hessian is indefinite
        }
    }
}

TEST_CASE_TEMPLATE("newton objective: the preconditioner is symmetric and positive definite", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    // One mesh with levels, one without.
    for (const int n : {test::sized(16, 4), 2})
        for (const bool pin_some : {false, true})
        {
            const levels_fixture s(test::bumpy(n, 0.3, 2), pin_some);
            auto f = s.make(energy::isometric{}, A::types());
            auto x = f.make_point();
            f.upload(s.start, x);
            f.linearize(x, false);
            const auto& space = f.space();
            auto v = space.make(), w = space.make(), Mv = space.make(), Mw = space.make();
            const double rounding = A::wide ? 1e-11 : 1e-4;
            std::mt19937 random(13);
            for (int trial = 0; trial < 5; ++trial)
            {
                v.upload(random_vector(f, random));
                w.upload(random_vector(f, random));
                f.precondition(v, Mv);
                f.precondition(w, Mw);
                CHECK(space.dot(v, Mv) > 0);
                CHECK(std::abs(space.dot(w, Mv) - space.dot(v, Mw)) <=
                      rounding * (std::sqrt(space.dot(w, w) * space.dot(Mv, Mv)) +
                                  std::sqrt(space.dot(v, v) * space.dot(Mw, Mw))));
            }
        }
}

TEST_CASE_TEMPLATE("newton objective: capped values are those at a fraction of the first flip", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    const levels_fixture s(hills());
    auto f = s.make(energy::isometric{}, A::types());
    auto x = f.make_point();
    f.upload(s.start, x);
    auto g = f.space().make(), d = f.space().make();
    f.gradient(x, g);
    const double tolerance = A::wide ? 1e-12 : 1e-5;
    f.space().axpby(-1, g, 0, d);
    const double most = f.max_step(x, d);
    REQUIRE(std::isfinite(most));
    const std::vector<double> a = {1, 0.5, 0.25, 0.125, 0.0625};
    for (const double factor : {0.01, 0.5, 3.0, 400.0}) // of a step that ends at the first flip
        for (const double fraction : {0.3, 0.9})
        {
            f.space().axpby(-factor * most, g, 0, d);
            std::vector<double> capped(a.size()), plain(a.size()), steps;
            const double unit = f.capped_values(x, d, fraction, a, capped);
            CHECK(unit == doctest::Approx(std::min(1.0, fraction / factor)).epsilon(10 * tolerance));
            CHECK(unit <= 1);
            for (const double t : a) steps.push_back(unit * t);
            f.values(x, d, steps, plain);
            for (std::size_t i = 0; i < a.size(); ++i)
                CHECK(capped[i] == doctest::Approx(plain[i]).epsilon(100 * tolerance));
        }
    // Nothing flips along a translation: the full step.
    d.upload(std::vector<double>(d.size(), 1));
    std::vector<double> values(a.size());
    CHECK(f.capped_values(x, d, 0.9, a, values) == 1);
    for (const double value : values) CHECK(value == doctest::Approx(f.value(x)).epsilon(100 * tolerance));
}

TEST_CASE("newton objective: what caps a step is named")
{
    const levels_fixture s(hills());
    auto f = s.make(energy::isometric{});
    auto x = f.make_point(), moved = f.make_point();
    // One vertex is about to cross an edge that it sees: only triangles at it can flip first.
    f.upload(s.start, x);
    auto d = f.space().make();
    std::vector<double> direction(d.size(), 0.0);
    direction[3] = 1;
    d.upload(direction);
    const auto found = f.capping(x, d);
    REQUIRE_FALSE(found.empty());
    CHECK(found.size() <= 16);
    const double most = f.max_step(x, d);
    for (const int c : found)
    {
        const auto& t = s.levels.cells(0)[static_cast<std::size_t>(c)];
        CHECK(std::count(t.begin(), t.end(), 3) == 1);
        const auto flips_at = [&](double a)
        {
            f.step(x, a, d, moved);
            const auto uv = f.download(moved);
            const auto at = [&](std::size_t k) { return uv[static_cast<std::size_t>(t[k])]; };
            return triangle::determinant({at(0), at(1), at(2)}) <= 0;
        };
        CHECK_FALSE(flips_at(0.999 * most));
        CHECK(flips_at(2.001 * most));
    }
}

TEST_CASE_TEMPLATE("newton objective: few waits an iteration, and the minimum that plain BFGS finds", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    const levels_fixture s(test::bumpy(test::sized(24, 4), 0.2, 3));
    auto f = s.make(energy::isometric{}, A::types());
    auto x = f.make_point();
    f.upload(s.start, x);
    f.warm_up(x);
    const auto before = s.q.counters();
    const auto r = solve::impl::newton(f, x, {.relax_below = 0});
    const auto waits = s.q.counters().waits - before.waits;
    CHECK(r.stop == solve::stop::gradient);
    CHECK(r.iterations >= 2);
    CHECK(r.waits == waits);
    // 2, one more where the systems become harder, one to make directions conjugate, one for the norm of the gradient
    // near the end of those; the start
    CHECK(static_cast<int>(waits) <= 4 * r.iterations + 1);
    CHECK(r.gradient_norm <= 1e-6);

    map_objective<triangle> g(s.q, s.levels.make_layout(0), energy::isometric{}, energy::weighting::measure);
    auto y = g.make_point();
    g.upload(s.start, y);
    const auto plain =
        solve::minimize(g, y, {.method = solve::method::lbfgs, .gradient_tolerance = 1e-9, .max_iterations = 5000});
    CHECK(r.value == doctest::Approx(plain.value).epsilon(1e-6));
    CHECK(r.value >= plain.value * (1 - 1e-7));
}
