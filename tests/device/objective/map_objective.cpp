// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/objective_cases.hpp>
#include <support/reference_problem.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/objective/map_objective.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::arithmetic, test::energies, test::largest, test::named_energy;

/// Costs more where the area grows beyond a limit. Its code chooses between two constants: these have no operand to
/// take their type from.
struct two_rates
{
    double limit;
    static constexpr bool barrier = false;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return select(e.det > T(limit), T(1), T(0.5)) * norm2(e.S);
    }
};

/// A curved surface, a start that is distorted but not folded, and everything around them.
struct value_fixture
{
    mesh<triangle> surface = test::bumpy(test::sized(14, 3), 0.4, 5);
    std::vector<vec2> start = barycentric_map(surface).uv;
    std::shared_ptr<const layout<triangle>> local;
    queue q{test::shared_context()};

    explicit value_fixture(bool pin_some = false)
    {
        std::vector<bool> pinned;
        if (pin_some)
            for (taut::idx v = 0; v < surface.vertex_count(); ++v) pinned.push_back(v % 3 == 0);
        local = std::make_shared<const layout<triangle>>(surface, pinned);
    }
};

/// The middle of the widest gap between the factors by which the start scales areas, those in the outer quarters aside:
/// whether an element grows more is no matter of rounding.
double gap_of_growth(const value_fixture& s)
{
    const ideal_elements<triangle> ideal(s.surface);
    std::vector<double> growth;
    for (std::size_t c = 0; c < s.surface.cells().size(); ++c)
    {
        const auto& t = s.surface.cells()[c];
        const auto at = [&](std::size_t k) { return s.start[static_cast<std::size_t>(t[k])]; };
        growth.push_back(triangle::determinant({at(0), at(1), at(2)}) * glm::determinant(ideal.inverse[c]));
    }
    std::sort(growth.begin(), growth.end());
    std::size_t widest = growth.size() / 4;
    for (std::size_t k = widest; k < 3 * growth.size() / 4; ++k)
        if (growth[k + 1] - growth[k] > growth[widest + 1] - growth[widest]) widest = k;
    return (growth[widest] + growth[widest + 1]) / 2;
}

} // namespace

TEST_CASE_TEMPLATE("map objective: value and gradient on the device are those of the host", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>, arithmetic<precision::fp32>)
{
    for (const bool pin_some : {false, true})
    {
        value_fixture s(pin_some);
        for (const named_energy& tried : energies())
            for (const auto weights : {energy::weighting::uniform, energy::weighting::measure})
            {
                CAPTURE(tried.name);
                CAPTURE(pin_some);
                map_objective<triangle> f(s.q, s.local, tried.energy, weights, A::types());
                const test::reference_problem<triangle> host(s.local, tried.energy, weights);
                auto x = f.make_point();
                f.upload(s.start, x);
                auto g = f.space().make();
                const double value = f.value_gradient(x, g);

                std::vector<double> expected(host.size());
                const double host_value = host(s.local->to_local(s.start), expected);
                CHECK(value == doctest::Approx(host_value).epsilon(A::tolerance));
                CHECK(f.value(x) == value);
                const auto gradient = g.download();
                std::vector<double> error(expected.size());
                for (std::size_t i = 0; i < error.size(); ++i) error[i] = gradient[i] - expected[i];
                CHECK(largest(error) <= A::tolerance * largest(expected));
            }
    }
}

TEST_CASE_TEMPLATE("map objective: an energy that chooses between two constants works in any precision", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>, arithmetic<precision::fp32>)
{
    value_fixture s;
    const any_energy energy = two_rates{gap_of_growth(s)};
    const auto kernels = std::make_shared<const newton_kernels<triangle>>(s.q, energy, A::types());
    map_objective<triangle> f(s.q, s.local, energy, energy::weighting::measure, A::types(), {kernels, &kernels->first});
    const test::reference_problem<triangle> host(s.local, energy, energy::weighting::measure);
    auto x = f.make_point();
    f.upload(s.start, x);
    auto g = f.space().make();
    const double value = f.value_gradient(x, g);
    std::vector<double> expected(host.size());
    CHECK(value == doctest::Approx(host(s.local->to_local(s.start), expected)).epsilon(A::tolerance));
    auto error = g.download();
    for (std::size_t i = 0; i < error.size(); ++i) error[i] -= expected[i];
    CHECK(largest(error) <= A::tolerance * largest(expected));

    const auto& first = kernels->first;
    const auto& relaxation = kernels->relaxation.value();
    for (const recorded_kernel* k :
         {&first.value, &first.gradient, &first.along, &first.first_flips, &kernels->second.launch,
          &relaxation.densities, &relaxation.terms, &relaxation.steps, &relaxation.tries, &relaxation.moves})
    {
        CAPTURE(k->text().name);
        if (k->text().rows) continue; // on the host there is no text
        const bool has_double = k->text().source.find("double") != std::string::npos;
        // A kernel that reads no positions is in the type of vectors.
        const bool no_positions = k == &relaxation.steps;
        CHECK(has_double == ((no_positions ? A::types().vector : A::types().position) == scalar_type::f64));
    }
}

TEST_CASE("map objective: pinned vertices have no gradient, so they never move")
{
    value_fixture s(true);
    map_objective<triangle> f(s.q, s.local, energy::isometric{}, energy::weighting::measure);
    auto x = f.make_point();
    f.upload(s.start, x);
    solve::minimize(f, x, {.max_iterations = 5});
    const auto moved = f.download(x);
    std::size_t still = 0;
    for (std::size_t v = 0; v < moved.size(); ++v)
        if (v % 3 == 0)
            CHECK(moved[v] == s.start[v]);
        else
            still += moved[v] == s.start[v];
    CHECK(still == 0);
}

TEST_CASE_TEMPLATE("map objective: a batch of trial steps is the value at each step", A, arithmetic<precision::fp64>,
                   arithmetic<precision::mixed>)
{
    value_fixture s;
    map_objective<triangle> f(s.q, s.local, energy::isometric{}, energy::weighting::measure, A::types());
    auto x = f.make_point(), moved = f.make_point();
    f.upload(s.start, x);
    auto g = f.space().make(), d = f.space().make();
    f.value_gradient(x, g);
    f.space().axpby(-1, g, 0, d);
    const double most = f.max_step(x, d);
    REQUIRE(std::isfinite(most));

    // More steps than one launch takes, and some beyond the first flip.
    const std::vector<double> a = {0, 0.1 * most, 0.3 * most, 0.5 * most, 0.9 * most, 1.01 * most, 2 * most};
    std::vector<double> values(a.size());
    f.values(x, d, a, values);
    for (std::size_t k = 0; k < a.size(); ++k)
    {
        f.step(x, a[k], d, moved);
        const double expected = f.value(moved);
        if (a[k] < most)
            CHECK(values[k] == doctest::Approx(expected).epsilon(10 * A::tolerance));
        else
            CHECK(std::isinf(values[k]));
    }
}

TEST_CASE("map objective: max_step is the first step that flips an element")
{
    value_fixture s;
    map_objective<triangle> f(s.q, s.local, energy::isometric{}, energy::weighting::measure);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    auto x = f.make_point(), moved = f.make_point();
    f.upload(s.start, x);
    for (int trial = 0; trial < 5; ++trial)
    {
        std::vector<double> direction(2 * s.local->vertex_stride, 0.0);
        for (auto& v : direction) v = normal(random);
        auto d = f.space().make();
        d.upload(direction);
        const double most = f.max_step(x, d);
        for (const double a : {0.25, 0.5, 0.9999})
        {
            f.step(x, a * most, d, moved);
            CHECK(std::isfinite(f.value(moved)));
        }
        f.step(x, 1.0001 * most, d, moved);
        CHECK(std::isinf(f.value(moved)));
    }
    // A translation flips nothing however far.
    auto shift = f.space().make();
    shift.upload(std::vector<double>(2 * s.local->vertex_stride, 1.0));
    CHECK(std::isinf(f.max_step(x, shift)));
}

TEST_CASE("map objective: a folded map has an infinite value")
{
    value_fixture s;
    map_objective<triangle> f(s.q, s.local, energy::isometric{}, energy::weighting::measure);
    auto folded = s.start;
    for (auto& p : folded) p.x = -p.x;
    auto x = f.make_point();
    f.upload(folded, x);
    CHECK(std::isinf(f.value(x)));
}

TEST_CASE("map objective: the device and the host model give the same iterates to rounding")
{
    value_fixture s;
    const any_energy energy = energy::isometric{};
    map_objective<triangle> f(s.q, s.local, energy, energy::weighting::measure);
    const test::reference_problem<triangle> reference(s.local, energy, energy::weighting::measure);
    auto host = solve::host_objective(reference.size(), reference);
    for (const auto method : {solve::method::lbfgs, solve::method::conjugate_gradient})
    {
        // Neither the exact barrier nor batches on the device, as the host model has neither: the same algorithm.
        struct plain
        {
            map_objective<triangle>& f;
            using point = map_objective<triangle>::point;
            using vector = map_objective<triangle>::vector;
            const auto& space() const { return f.space(); }
            point make_point() const { return f.make_point(); }
            void copy(const point& a, point& b) const { f.copy(a, b); }
            void step(const point& x, double a, const vector& d, point& out) const { f.step(x, a, d, out); }
            double value(const point& x) { return f.value(x); }
            double value_gradient(const point& x, vector& g) { return f.value_gradient(x, g); }
        } device{f};
        // Brent's method would find the same minimum along a line only to half the digits.
        const solve::params params{
            .method = method, .line_search = solve::line_search_method::strong_wolfe, .max_iterations = 8};
        auto x = f.make_point();
        f.upload(s.start, x);
        const auto on_device = solve::minimize(device, x, params);
        auto y = s.local->to_local(s.start);
        const auto on_host = solve::minimize(host, y, params);

        REQUIRE(on_device.history.size() == on_host.history.size());
        for (std::size_t k = 0; k < on_host.history.size(); ++k)
            CHECK(on_device.history[k].value == doctest::Approx(on_host.history[k].value).epsilon(1e-9));
        const auto a = f.download(x), b = s.local->to_user(y);
        double difference = 0;
        for (std::size_t v = 0; v < a.size(); ++v) difference = std::max(difference, glm::length(a[v] - b[v]));
        CHECK(difference < 1e-7);
    }
}

TEST_CASE(
    "map objective: the gradient of a tetrahedron is recorded, and its host reference has the cube at rest as minimum")
{
    const auto rest = test::cube(2);
    const auto local = std::make_shared<const layout<tetrahedron>>(rest);
    queue q(test::shared_context());
    const any_energy energy = energy::isometric{};
    const auto text = element_kernels<tetrahedron>::record_gradient(energy, {}, kernel_form::guarded);
    CHECK(text.source.find("corner_gradient") != std::string::npos);
    const test::reference_problem<tetrahedron> host(local, energy, energy::weighting::measure);
    std::vector<double> g(host.size());
    CHECK(host(local->to_local(rest.points()), g) == doctest::Approx(2.0));
    CHECK(largest(g) < 1e-12);
}
