// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/size.hpp>

#include <support/lane_forms.hpp>
#include <support/operator_step.hpp>
#include <support/shared_context.hpp>
#include <taut/impl/core/untangle/device/untangle_operator.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// The rest positions as a map.
template <class Element>
std::vector<vec<Element::dimension>> identity(const mesh<Element>& m)
{
    std::vector<vec<Element::dimension>> x;
    for (const vec3& p : m.points())
    {
        vec<Element::dimension> q;
        for (int c = 0; c < Element::dimension; ++c) q[c] = p[c];
        x.push_back(q);
    }
    return x;
}

/// The identity with its rim held, of a mesh of the unit square or cube.
template <class Element>
untangle_problem<Element> boxed(mesh<Element> m)
{
    untangle_problem<Element> p{std::move(m), {}, {}};
    p.initial = identity(p.rest);
    p.held = fixed_marks<Element::dimension>(p.initial.size());
    for (std::size_t v = 0; v < p.initial.size(); ++v)
        for (int c = 0; c < Element::dimension; ++c)
            if (p.initial[v][c] == 0 || p.initial[v][c] == 1) p.held[v] = p.held.every;
    return p;
}

/// Moves what is free by up to `size` in each coordinate.
template <class Element>
void jitter(untangle_problem<Element>& p, double size, unsigned seed)
{
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> draw(-size, size);
    for (std::size_t v = 0; v < p.held.size(); ++v)
        for (int c = 0; c < Element::dimension; ++c)
            if (!p.held.test(v, c)) p.initial[v][c] += draw(generator);
}

/// Whether every held coordinate of x is that of the problem, bit for bit.
template <class Element>
bool holds(const untangle_problem<Element>& p, const std::vector<vec<Element::dimension>>& x)
{
    bool all = x.size() == p.initial.size();
    for (std::size_t v = 0; all && v < x.size(); ++v)
        for (int c = 0; c < Element::dimension; ++c) all = all && (!p.held.test(v, c) || x[v][c] == p.initial[v][c]);
    return all;
}

template <class Element>
std::size_t flipped(const mesh<Element>& m, const std::vector<vec<Element::dimension>>& x)
{
    return certify<Element::dimension>(m.cells(), std::span<const vec<Element::dimension>>(x)).flipped;
}

/// The largest distance between two maps, by what the start and the first of them differ.
template <int D>
double deviation(const std::vector<vec<D>>& start, const std::vector<vec<D>>& a, const std::vector<vec<D>>& b)
{
    double moved = 0, apart = 0;
    for (std::size_t v = 0; v < a.size(); ++v)
    {
        moved = std::max(moved, glm::length(a[v] - start[v]));
        apart = std::max(apart, glm::length(a[v] - b[v]));
    }
    return apart / moved;
}

/// A square of which one inner triangle is pinned upside down.
untangle_problem<triangle> with_pinned_fold(int n)
{
    auto p = boxed(test::grid(n, n));
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * (n + 1) + i); };
    const int i = n / 2;
    std::swap(p.initial[at(i, i)], p.initial[at(i + 1, i)]);
    for (const std::size_t v : {at(i, i), at(i + 1, i), at(i, i + 1), at(i + 1, i + 1)}) p.held[v] = p.held.every;
    return p;
}

/// A step of the host in the units of the device.
template <class Element>
std::vector<vec<Element::dimension>> host_step(const untangle_problem<Element>& p, const operator_params& how)
{
    constexpr int D = Element::dimension;
    const operator_frame<D> frame(p.rest.cells(), p.initial);
    auto x = p.initial;
    for (auto& q : x) q = (q - frame.centre) * frame.scale;
    const operator_step<Element> step{how.delta, how.beta, how.shear, how.margin + frame.rounding()};
    auto moved = step(p.rest, x, p.held);
    for (auto& q : moved) q = q / frame.scale + frame.centre;
    return moved;
}

} // namespace

TEST_CASE_TEMPLATE(
    "untangling operator: a move on the device is that of the host, in the form for CPUs and in that for GPUs", Element,
    triangle, tetrahedron)
{
    queue q(test::shared_context());
    const auto problem = [](unsigned seed)
    {
        if constexpr (Element::dimension == 2)
        {
            const int n = test::sized(40, 5);
            auto p = boxed(test::grid(n, n));
            jitter(p, 0.8 / n, seed);
            return p;
        }
        else
        {
            const int n = test::sized(8, 2);
            auto p = boxed(test::cube(n));
            jitter(p, 0.8 / n, seed);
            return p;
        }
    };
    operator_params how;
    how.iterations = 1;
    how.beta = 0.5;
    how.margin = 0.05;
    how.delta = 0.1;
    for (const double shear : {0.0, 1.0})
        for (const lane_form form : test::lane_forms())
        {
            how.shear = shear;
            int compared = 0;
            for (unsigned seed = 1; seed <= 8 && compared < 2; ++seed)
            {
                const auto p = problem(seed);
                const auto r = untangle_operator<Element>(q, p, form).run(p.initial, how);
                CHECK(r.iterations <= 1);
                if (r.best_iteration == 0) continue; // the state before the move was the better one
                CHECK(deviation<Element::dimension>(p.initial, host_step(p, how), r.map) < 2e-4);
                ++compared;
            }
            CHECK(compared == 2);
        }
}

TEST_CASE("untangling operator: the step of the host is downhill along its objective")
{
    auto p = boxed(test::grid(6, 6));
    jitter(p, 0.2, 7);
    const operator_step<triangle> step{.delta = 1e-6, .beta = 0.01, .shear = 0, .margin = 0};
    const auto x = step(p.rest, p.initial, p.held);
    double squared = 0;
    for (std::size_t v = 0; v < x.size(); ++v) squared += glm::dot(x[v] - p.initial[v], x[v] - p.initial[v]);
    const double fall = step.value(p.rest, p.initial) - step.value(p.rest, x);
    CHECK(fall == doctest::Approx(squared / step.delta).epsilon(1e-3)); // delta |gradient|^2
}

TEST_CASE("untangling operator: a square with a scrambled interior becomes injective, its rim in place")
{
    queue q(test::shared_context());
    const int n = test::sized(32, 6);
    auto p = boxed(test::grid(n, n));
    jitter(p, 0.2, 3);
    // Neither the origin nor a length that single precision likes.
    for (auto& x : p.initial) x = 1e-3 * x + vec2(7.0, -3.0) + vec2(1.0 / 3);
    const auto r = untangle_operator<triangle>(q, p).run(p.initial);
    CHECK(r.inverted_before > 0);
    CHECK(bool(r));
    CHECK(r.why == operator_stop::untangled);
    CHECK(flipped(p.rest, r.map) == 0);
    CHECK(r.after.min_det > 0);
    CHECK(r.iterations == r.best_iteration);
    CHECK(holds(p, r.map));
}

TEST_CASE("untangling operator: a collapsed interior unfolds")
{
    queue q(test::shared_context());
    const int n = test::sized(16, 4);
    auto p = boxed(test::grid(n, n));
    for (std::size_t v = 0; v < p.held.size(); ++v)
        if (!p.held.all(v)) p.initial[v] = vec2(0.4, 0.55);
    const auto r = untangle_operator<triangle>(q, p).run(p.initial);
    CHECK(bool(r));
    CHECK(holds(p, r.map));
}

TEST_CASE("untangling operator: a jittered box of tetrahedra becomes injective")
{
    queue q(test::shared_context());
    const int n = test::sized(8, 3);
    auto p = boxed(test::cube(n));
    jitter(p, 0.6 / n, 5);
    const auto r = untangle_operator<tetrahedron>(q, p).run(p.initial);
    CHECK(r.inverted_before > 0);
    CHECK(bool(r));
    CHECK(holds(p, r.map));
}

TEST_CASE("untangling operator: a coordinate held alone stays, the other one moves")
{
    queue q(test::shared_context());
    const int n = test::sized(12, 4);
    auto p = boxed(test::grid(n, n));
    // Vertices of the rim slide along it, which Algorithm 2 does not know.
    const auto corner = [](double t) { return t == 0 || t == 1; };
    for (std::size_t v = 0; v < p.held.size(); ++v)
    {
        const vec2 x = p.initial[v];
        if (!corner(x.x) || !corner(x.y))
            p.held[v] = static_cast<std::uint8_t>((corner(x.x) ? 1 : 0) | (corner(x.y) ? 2 : 0));
    }
    jitter(p, 0.9 / n, 11);
    const auto r = untangle_operator<triangle>(q, p).run(p.initial);
    CHECK(r.inverted_before > 0);
    CHECK(r.after.flipped < r.inverted_before);
    CHECK(holds(p, r.map));
}

TEST_CASE("untangling operator: held coordinates are those of the problem, whatever the start says")
{
    queue q(test::shared_context());
    const auto p = boxed(test::grid(5, 5));
    auto start = p.initial;
    for (auto& x : start) x += vec2(10.0);
    const auto r = untangle_operator<triangle>(q, p).run(start);
    CHECK(r.inverted_before > 0);
    CHECK(holds(p, r.map));
}

TEST_CASE("untangling operator: a map without folds comes back bit for bit")
{
    queue q(test::shared_context());
    auto p = boxed(test::grid(6, 6));
    for (auto& x : p.initial) x = x / 3.0 + vec2(0.1);
    const auto r = untangle_operator<triangle>(q, p).run(p.initial);
    CHECK(bool(r));
    CHECK(r.why == operator_stop::untangled);
    CHECK(r.iterations == 0);
    CHECK(r.map == p.initial);
}

TEST_CASE("untangling operator: a margin lifts the smallest determinant")
{
    queue q(test::shared_context());
    const int n = test::sized(16, 5);
    auto p = boxed(test::grid(n, n));
    jitter(p, 1.0 / n, 13);
    untangle_operator<triangle> untangle(q, p);
    operator_params how;
    const auto barely = untangle.run(p.initial, how);
    how.margin = 0.05;
    const auto clearly = untangle.run(p.initial, how);
    REQUIRE(barely.inverted_before > 0);
    CHECK(bool(barely));
    CHECK(bool(clearly));
    double mean = 0;
    for (const auto& c : p.rest.cells())
    {
        const auto at = [&](std::size_t k) { return p.initial[static_cast<std::size_t>(c[k])]; };
        mean += std::abs(triangle::determinant({at(0), at(1), at(2)})) / double(p.rest.cells().size());
    }
    CHECK(clearly.after.min_det > 0.049 * mean);
}

TEST_CASE("untangling operator: what is pinned upside down ends the run with inverted elements, not with a fold hidden")
{
    queue q(test::shared_context());
    const auto p = with_pinned_fold(8);
    for (const auto schedule : {operator_schedule::literal, operator_schedule::patience, operator_schedule::constant})
    {
        operator_params how;
        how.schedule = schedule;
        how.iterations = 100;
        const auto r = untangle_operator<triangle>(q, p).run(p.initial, how);
        CHECK_FALSE(bool(r));
        CHECK((r.why == operator_stop::iterations || r.why == operator_stop::step));
        CHECK(r.iterations <= 100);
        CHECK(r.after.flipped == flipped(p.rest, r.map));
        CHECK(r.after.flipped >= 1);
        CHECK(r.after.flipped <= r.inverted_before);
        CHECK(holds(p, r.map));
    }
}

TEST_CASE("untangling operator: schedules differ in how they shorten the step")
{
    queue q(test::shared_context());
    const auto p = with_pinned_fold(8);
    untangle_operator<triangle> untangle(q, p);
    operator_params how;
    how.iterations = 60;
    how.delta = 0.25;

    SUBCASE("constant: never")
    {
        how.schedule = operator_schedule::constant;
        CHECK(untangle.run(p.initial, how).delta == 0.25);
    }
    SUBCASE("literal: at each increase, until it stands still")
    {
        how.schedule = operator_schedule::literal;
        how.iterations = 5000;
        const auto r = untangle.run(p.initial, how);
        CHECK(r.why == operator_stop::step);
        CHECK(r.delta < how.least_delta);
        CHECK(r.delta > 0.4 * how.least_delta);
    }
    SUBCASE("patience: later than literally, by halves")
    {
        const double patient = untangle.run(p.initial, how).delta;
        how.schedule = operator_schedule::literal;
        const double literal = untangle.run(p.initial, how).delta;
        CHECK(patient > literal);
        CHECK(std::fmod(std::log2(how.delta / patient), 1.0) == 0);
        how.schedule = operator_schedule::patience;
        how.patience = 1;
        CHECK(untangle.run(p.initial, how).delta == literal);
    }
}

TEST_CASE("untangling operator: what an iteration decides on the device is what the host decides, in both forms")
{
    // As in untangle.cl: why it stopped, moves, improved, inverted, below, the best's three, streak, delta, value.
    using state = std::array<taut::idx, 11>;
    enum
    {
        running,
        untangled,
        short_step,
        not_finite
    };
    const auto bits = [](float x) { return std::bit_cast<taut::idx>(x); };
    const auto number = [](taut::idx x) { return std::bit_cast<float>(x); };
    queue q(test::shared_context());
    std::mt19937 random(3);
    const auto below = [&](int n) { return static_cast<taut::idx>(random() % static_cast<unsigned>(n)); };
    for (const impl::lane_form form : test::lane_forms())
    {
        const int items = form.lanes == 1 ? 256 : 1;
        const kernel decide =
            impl::make_kernel(q, impl::untangle_program(2, static_cast<std::size_t>(items), form), "untangle_decide");
        for (int trial = 0; trial < test::sized(60, 20); ++trial)
        {
            CAPTURE(items);
            CAPTURE(trial);
            const auto groups = 1 + static_cast<std::size_t>(below(600));
            std::vector<float> partials(3 * groups);
            float value = 0;
            taut::idx inverted = 0, low = 0;
            const bool none_below = below(6) == 0;
            for (std::size_t g = 0; g < groups; ++g)
            {
                partials[g] = 0.25f * static_cast<float>(below(64)); // sums without rounding
                partials[2 * groups + g] = none_below ? 0.0f : static_cast<float>(below(5));
                partials[groups + g] = std::min(partials[2 * groups + g], static_cast<float>(below(3)));
                value += partials[g];
                inverted += static_cast<taut::idx>(partials[groups + g]);
                low += static_cast<taut::idx>(partials[2 * groups + g]);
            }
            if (below(8) == 0) value = partials[groups / 2] = std::numeric_limits<float>::infinity();
            const taut::idx patience = below(4);
            const float least = 0.01f;
            state s{below(7) == 0 ? 1 : 0,
                    17,
                    0,
                    -1,
                    -1,
                    inverted - 1 + below(3),
                    low - 1 + below(3),
                    9,
                    below(3),
                    bits(below(5) == 0 ? 0.015f : 0.5f),
                    bits(below(2) ? value : value + 1)};

            state expected = s;
            if (s[0] == running)
            {
                expected[3] = inverted;
                expected[4] = low;
                expected[2] = inverted < s[5] || (inverted == s[5] && low < s[6]);
                if (expected[2]) expected[5] = inverted, expected[6] = low, expected[7] = s[1];
                expected[8] = value >= number(s[10]) ? s[8] + 1 : 0;
                float delta = number(s[9]);
                if (patience > 0 && expected[8] >= patience) delta /= 2, expected[8] = 0;
                expected[9] = bits(delta);
                expected[10] = bits(value);
                expected[0] = low == 0                ? untangled
                              : !std::isfinite(value) ? not_finite
                              : delta < least         ? short_step
                                                      : running;
                if (expected[0] == running) ++expected[1];
            }
            const buffer<float> sums(q, partials);
            buffer<taut::idx> on_device(q, std::vector<taut::idx>(s.begin(), s.end()));
            const auto team = static_cast<std::size_t>(items);
            decide({team, team}, static_cast<taut::idx>(groups), patience, least, sums, on_device);
            CHECK(on_device.download() == std::vector<taut::idx>(expected.begin(), expected.end()));
        }
    }
}

TEST_CASE("untangling operator: the same input gives the same map")
{
    queue q(test::shared_context());
    auto p = boxed(test::grid(8, 8));
    jitter(p, 0.2, 17);
    untangle_operator<triangle> untangle(q, p);
    const auto once = untangle.run(p.initial);
    operator_params how;
    how.batch = 3; // how often the host looks changes nothing
    const auto again = untangle.run(p.initial, how);
    CHECK(once.map == again.map);
    CHECK(once.iterations == again.iterations);
}

TEST_CASE("untangling operator: the observer and the time limit end a run with the best map so far")
{
    queue q(test::shared_context());
    const auto p = with_pinned_fold(8);
    untangle_operator<triangle> untangle(q, p);
    operator_params how;
    how.iterations = std::numeric_limits<int>::max();
    how.schedule = operator_schedule::constant;
    how.delta = 0.01;

    SUBCASE("observer")
    {
        int asked = 0;
        how.observer = [&](const taut::progress& now)
        {
            CHECK(now.value > 0);
            CHECK(now.step == doctest::Approx(0.01));
            return ++asked < 3;
        };
        const auto r = untangle.run(p.initial, how);
        CHECK(r.why == operator_stop::user);
        CHECK(asked == 3);
        CHECK(r.iterations <= 3 * how.batch);
        CHECK(holds(p, r.map));
    }
    SUBCASE("time limit")
    {
        how.time_limit = std::chrono::duration<double>(0);
        const auto r = untangle.run(p.initial, how);
        CHECK(r.why == operator_stop::time);
        CHECK(r.after.flipped <= r.inverted_before);
        CHECK(holds(p, r.map));
    }
}

TEST_CASE("untangling operator: steps without measure end the run, and the start is kept")
{
    queue q(test::shared_context());
    auto p = boxed(test::grid(6, 6));
    jitter(p, 0.3, 19);
    operator_params how;
    how.schedule = operator_schedule::constant;
    how.delta = 1e20;
    const auto r = untangle_operator<triangle>(q, p).run(p.initial, how);
    CHECK(r.why == operator_stop::not_finite);
    CHECK(r.after.flipped <= r.inverted_before);
    CHECK(holds(p, r.map));
}

TEST_CASE("untangling operator: extreme starts are answered, too")
{
    queue q(test::shared_context());
    auto p = boxed(test::grid(3, 3));
    operator_params how;
    how.iterations = 50;
    SUBCASE("all points in one")
    {
        for (auto& x : p.initial) x = vec2(2.0, 3.0);
        const auto r = untangle_operator<triangle>(q, p).run(p.initial, how);
        CHECK_FALSE(bool(r));
        CHECK(r.after.flipped == 18);
    }
    SUBCASE("everything is held")
    {
        for (std::size_t v = 0; v < p.held.size(); ++v) p.held[v] = p.held.every;
        std::swap(p.initial[0], p.initial[5]);
        const auto r = untangle_operator<triangle>(q, p).run(p.initial, how);
        CHECK_FALSE(bool(r));
        CHECK(r.map == p.initial);
    }
    SUBCASE("very large and very small")
    {
        for (const double scale : {1e-150, 1e150})
        {
            auto s = p;
            std::swap(s.initial[5], s.initial[6]);
            for (auto& x : s.initial) x *= scale;
            const auto r = untangle_operator<triangle>(q, s).run(s.initial, how);
            CHECK(bool(r));
            CHECK(holds(s, r.map));
        }
    }
}

TEST_CASE("untangling operator: bad input is refused by name")
{
    queue q(test::shared_context());
    auto p = boxed(test::grid(2, 2));
    untangle_operator<triangle> untangle(q, p);
    const auto refuses = [&](auto change, const char* field)
    {
        operator_params how;
        change(how);
        try
        {
            untangle.run(p.initial, how);
            FAIL("no error");
        }
        catch (const parameter_error& e)
        {
            CHECK(e.field() == field);
        }
    };
    refuses([](auto& h) { h.delta = 0; }, "delta");
    refuses([](auto& h) { h.patience = 0; }, "patience");
    refuses([](auto& h) { h.least_delta = -1; }, "least_delta");
    refuses([](auto& h) { h.beta = 0; }, "beta");
    refuses([](auto& h) { h.shear = std::numeric_limits<double>::quiet_NaN(); }, "shear");
    refuses([](auto& h) { h.margin = -1; }, "margin");
    refuses([](auto& h) { h.iterations = -1; }, "iterations");
    refuses([](auto& h) { h.batch = 0; }, "batch");
    refuses([](auto& h) { h.time_limit = std::chrono::duration<double>(-1); }, "time_limit");
    auto start = p.initial;
    start[4].x = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(untangle.run(start), parameter_error);
    start.pop_back();
    CHECK_THROWS_AS(untangle.run(start), parameter_error);
    p.held = fixed_marks<2>(p.held.size() - 1);
    CHECK_THROWS_AS(untangle_operator<triangle>(q, p), parameter_error);
}
