// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using namespace std::chrono_literals;

mesh<triangle> moved(const mesh<triangle>& m, double scale, vec3 by)
{
    auto points = m.points();
    for (auto& p : points) p = p * scale + by;
    return {points, m.cells()};
}

mesh<triangle> dome()
{
    return test::bumpy(test::sized(16, 3), 0.3, 2);
}

/// The default, and the one without a hierarchy.
constexpr solve::method methods[] = {solve::method::automatic, solve::method::lbfgs};

/// Energies fall monotonically, up to the rounding of a value.
void check_falling(const solve::report& r, precision how = precision::fp64)
{
    const double rounding = how == precision::fp64 ? 1e-13 : 2e-8;
    for (std::size_t k = 1; k < r.history.size(); ++k)
        CHECK(r.history[k].value <= r.history[k - 1].value * (1 + rounding));
}

} // namespace

TEST_CASE("parameterize: every energy, weighting, boundary and precision gives a certified map")
{
    queue q(test::shared_context());
    const auto m = dome();
    for (const auto& energy :
         {any_energy(energy::isometric{}), any_energy(energy::shape{}), any_energy(energy::area{})})
        for (const auto weights : {energy::weighting::uniform, energy::weighting::measure})
            for (const auto boundary : {boundary_mode::free, boundary_mode::fixed})
                for (const auto how : {precision::fp64, precision::mixed, precision::fp32})
                    for (const auto method : methods)
                    {
                        const auto r = parameterize(q, m,
                                                    {.energy = energy,
                                                     .weights = weights,
                                                     .boundary = boundary,
                                                     .precision = how,
                                                     .solve = {.method = method, .max_iterations = 15}});
                        REQUIRE(r);
                        CHECK(r.report.flips.flipped == 0);
                        CHECK(r.report.precision == how);
                        CHECK(r.report.solve.value <= r.report.solve.value_start);
                        if (method != solve::method::automatic)
                            CHECK(r.report.solve.value < r.report.solve.value_start);
                        check_falling(r.report.solve, how);
                        CHECK(r.uv.size() == m.points().size());
                        CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
                    }
}

TEST_CASE("parameterize: a developable surface is flattened without distortion")
{
    queue q(test::shared_context());
    // Part of a cylinder: isometric to a rectangle.
    const auto flat = test::grid(test::sized(12, 4), test::sized(12, 4));
    auto points = flat.points();
    for (auto& p : points) p = {std::sin(p.x), p.y, std::cos(p.x)};
    const mesh<triangle> bent(points, flat.cells());
    const auto r = parameterize(q, bent, {.solve = {.gradient_tolerance = 1e-7}});
    REQUIRE(r);
    CHECK(r.report.solve.stop == solve::stop::gradient);
    CHECK(r.report.solve.value == doctest::Approx(4.0).epsilon(1e-3)); // its triangles are chords, almost isometric
    CHECK(measure_quality(bent, r.uv).stretch_l2.max < 1.05);
}

TEST_CASE("parameterize: size and place of the model do not matter")
{
    queue q(test::shared_context());
    const auto m = dome();
    for (const auto method : methods)
    {
        const parameterize_params params{.precision = precision::fp64,
                                         .solve = {.method = method, .max_iterations = 20}};
        const auto reference = parameterize(q, m, params);
        const auto width = [](const map_result& r) { return glm::length(r.uv.front() - r.uv.back()); };
        // Powers of two change no digit, others the last ones.
        for (const double scale : {std::ldexp(1.0, -30), std::ldexp(1.0, 30), 1e-9, 0.37, 1e9})
        {
            const bool exact = std::ldexp(1.0, std::ilogb(scale)) == scale;
            const auto r = parameterize(q, moved(m, scale, vec3(0)), params);
            REQUIRE(r);
            CHECK(r.report.solve.value == doctest::Approx(reference.report.solve.value).epsilon(exact ? 1e-12 : 1e-5));
            CHECK(width(r) / scale == doctest::Approx(width(reference)).epsilon(exact ? 1e-12 : 1e-3));
        }
        const auto far = parameterize(q, moved(m, 1, vec3(1e5, -1e5, 1e5)), params);
        REQUIRE(far);
        CHECK(far.report.solve.value == doctest::Approx(reference.report.solve.value).epsilon(1e-3));
    }
}

TEST_CASE("parameterize: a fixed boundary stays where the start has it, bit for bit")
{
    queue q(test::shared_context());
    const auto m = dome();
    for (const auto boundary : {boundary_mode::fixed, boundary_mode::square})
        for (const auto how : {precision::fp64, precision::mixed, precision::fp32})
            for (const auto method : methods)
            {
                const auto r = parameterize(q, m,
                                            {.boundary = boundary,
                                             .start = start_method::barycentric,
                                             .precision = how,
                                             .solve = {.method = method, .max_iterations = 10}});
                REQUIRE(r);
                const auto loops = boundary_loops(m);
                for (const auto v : loops.front())
                    CHECK(r.uv[static_cast<std::size_t>(v)] == r.report.start.uv[static_cast<std::size_t>(v)]);
            }
}

TEST_CASE("parameterize: a scale-invariant energy returns the area of the surface")
{
    queue q(test::shared_context());
    const auto m = dome();
    const auto r = parameterize(q, m, {.energy = energy::shape{}, .solve = {.max_iterations = 50}});
    REQUIRE(r);
    double rest = 0, mapped = 0;
    for (taut::idx c = 0; c < m.cell_count(); ++c)
    {
        rest += glm::length(glm::cross(m.rest(c)[1] - m.rest(c)[0], m.rest(c)[2] - m.rest(c)[0])) / 2;
        const auto& t = m.cells()[static_cast<std::size_t>(c)];
        const auto at = [&](std::size_t k) { return r.uv[static_cast<std::size_t>(t[k])]; };
        mapped += triangle::determinant({at(0), at(1), at(2)}) / 2;
    }
    CHECK(mapped == doctest::Approx(rest).epsilon(1e-12));
}

TEST_CASE("parameterize: a start of one's own is taken, turned over if it is mirrored, untangled if folded")
{
    queue q(test::shared_context());
    const auto m = dome();
    auto start = barycentric_map(m).uv;
    const parameterize_params few{.initial = start, .solve = {.max_iterations = 3}};
    CHECK(parameterize(q, m, few));

    auto mirrored = few;
    for (auto& p : mirrored.initial) p.y = -p.y;
    const auto turned = parameterize(q, m, mirrored);
    CHECK(turned);
    CHECK(turned.report.notes.size() == 1);

    auto folded = few;
    const auto& t = m.cells()[7];
    std::swap(folded.initial[static_cast<std::size_t>(t[0])], folded.initial[static_cast<std::size_t>(t[1])]);
    const auto untangled = parameterize(q, m, folded);
    CHECK(untangled);
    CHECK(untangled.report.notes.size() == 1);
    CHECK_FALSE(untangled.report.untangling.empty());

    // Nothing helps where the fold is in the boundary and that is fixed.
    folded.boundary = boundary_mode::fixed;
    const auto loop = boundary_loops(m)[0];
    for (std::size_t k = 0; k < loop.size(); ++k)
        folded.initial[static_cast<std::size_t>(loop[k])] = start[static_cast<std::size_t>(loop[loop.size() - 1 - k])];
    const auto refused = parameterize(q, m, folded);
    CHECK_FALSE(refused);
    CHECK(refused.report.outcome == outcome::infeasible);
    CHECK_FALSE(refused.reason().empty());
    CHECK_FALSE(refused.report.ids.empty());

    auto wrong_size = few;
    wrong_size.initial.pop_back();
    CHECK_THROWS_AS(parameterize(q, m, wrong_size), parameter_error);
}

TEST_CASE("parameterize: place and scale of a start do not matter to a free boundary, in float either")
{
    queue q(test::shared_context());
    const auto m = dome();
    const auto start = barycentric_map(m).uv;
    for (const auto how : {precision::fp64, precision::mixed, precision::fp32})
        for (const auto method : methods)
        {
            const auto run = [&](double scale, double shift)
            {
                auto initial = start;
                for (auto& p : initial) p = p * scale + vec2(shift);
                const solve::params few{.method = method, .max_iterations = 60};
                return parameterize(q, m, {.initial = initial, .precision = how, .solve = few}).report.solve.value;
            };
            // Single precision keeps few digits of positions so far away, and L-BFGS is still on its way.
            const bool arrives = how == precision::fp64 && method == solve::method::automatic;
            const double tolerance = arrives ? 1e-5 : 1e-2, reference = run(1, 0);
            CHECK(run(1, 1e4) == doctest::Approx(reference).epsilon(tolerance));
            CHECK(run(1e-3, 0) == doctest::Approx(reference).epsilon(tolerance));
            CHECK(run(std::ldexp(1.0, 960), 0) == doctest::Approx(reference).epsilon(tolerance));
        }
}

TEST_CASE("parameterize: models of extreme size do not overflow")
{
    queue q(test::shared_context());
    for (const double scale : {1e-290, 1e290})
        for (const auto method : methods)
        {
            const auto m = moved(dome(), scale, vec3(0));
            const auto r = parameterize(q, m, {.solve = {.method = method, .max_iterations = 20}});
            REQUIRE(r);
            CHECK(std::isfinite(r.report.solve.value));
            CHECK(r.report.solve.value <= r.report.solve.value_start);
            CHECK(measure_quality<triangle>(m, r.uv).isometric.measure ==
                  doctest::Approx(r.report.solve.value).epsilon(1e-6));
        }
}

TEST_CASE("parameterize: at the ends of the range of double a map is certified as it is returned, or refused")
{
    queue q(test::shared_context());
    int valid = 0, refused = 0;
    for (const double scale : {std::ldexp(1.0, -1071), std::ldexp(1.0, -1069), std::ldexp(1.0, -1060), 1e-300, 1e300})
    {
        CAPTURE(scale);
        const auto m = moved(test::bumpy(12, 0.3), scale, vec3(0));
        if (!check(m).empty()) continue; // rounded to flat triangles
        const auto r = parameterize(q, m, {.solve = {.max_iterations = 20}});
        const auto recount = certify<2>(m.cells(), r.uv);
        CHECK(recount.defects() == r.report.flips.defects());
        CHECK(static_cast<bool>(r) == static_cast<bool>(recount));
        CHECK(static_cast<bool>(r) == r.reason().empty());
        (r ? valid : refused) += 1;
    }
    CHECK(valid >= 2);
    CHECK(valid + refused >= 3);
}

namespace
{
/// No barrier, and least where everything collapses to a point.
struct dirichlet
{
    static constexpr bool barrier = false;
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return norm2(e.S);
    }
};
} // namespace

TEST_CASE("parameterize: an energy without a barrier folds nothing; what cannot be certified gives the start back")
{
    queue q(test::shared_context());
    const auto m = dome();
    for (const auto method : methods)
        for (const auto boundary : {boundary_mode::free, boundary_mode::fixed})
        {
            const auto r =
                parameterize(q, m, {.energy = dirichlet{}, .boundary = boundary, .solve = {.method = method}});
            REQUIRE(r);
            CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
            if (r.uv == r.report.start.uv)
            {
                CHECK_FALSE(r.report.notes.empty());
                CHECK(r.report.solve.value == r.report.solve.value_start);
            }
        }
}

TEST_CASE("parameterize: without double precision the start survives what float cannot hold")
{
    queue q(find_device().without_fp64());
    const auto m = dome();
    for (const auto method : methods)
    {
        CHECK(parameterize(
            q, m,
            {.energy = dirichlet{}, .precision = precision::fp32, .solve = {.method = method, .max_iterations = 300}}));
        // By default it does with what the device has.
        const auto r = parameterize(q, m, {.solve = {.method = method, .gradient_tolerance = 1e-4}});
        CHECK(r);
        CHECK(r.report.precision == precision::fp32);
        CHECK_THROWS_AS(parameterize(q, m, {.precision = precision::fp64, .solve = {.method = method}}), device_error);
    }
}

TEST_CASE("parameterize: parameters outside their domain are named")
{
    queue q(test::shared_context());
    const auto m = test::single_triangle();
    const auto field_of = [&](const parameterize_params& p, const run_limits& limits = {})
    {
        try
        {
            parameterize(q, m, p, limits);
        }
        catch (const parameter_error& e)
        {
            return e.field();
        }
        return std::string();
    };
    CHECK(field_of({.precision = static_cast<precision>(9)}) == "precision");
    CHECK(field_of({.boundary = static_cast<boundary_mode>(7)}) == "boundary");
    CHECK(field_of({}, {.time_limit = -3s}) == "time_limit");
    CHECK(field_of({.start = static_cast<start_method>(9)}) == "start");
    CHECK(field_of({.start = start_method::barycentric, .tuning = {.stretch_rounds = -1}}) == "stretch_rounds");
    CHECK(field_of({.solve = {.tuning = {.newton = {.relax_below = 2}}}}) == "newton.relax_below");
    CHECK(field_of({.solve = {.tuning = {.line = {.shrink = 0.4}}}}) == "line_search");
}

TEST_CASE("parameterize: stopping for any reason leaves a valid map once there is one")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(40, 3), 0.5, 3);
    for (const auto method : methods)
    {
        const auto endless = solve::params{.method = method, .gradient_tolerance = 0, .max_iterations = 100000};

        int asked = 0;
        const auto until = [&](auto&& goes_on)
        {
            asked = 0;
            return parameterize(q, m, {.solve = endless},
                                {.observer = [&](const taut::progress& p) { return goes_on(++asked, p.usable); }});
        };
        until([](int, bool usable) { return !usable; });
        const int first = asked; // question with a map in hand
        for (const int questions : {1, first - 1, first, first + 1, first + 5, first + 19})
        {
            CAPTURE(questions);
            const auto cancelled = until([=](int question, bool) { return question < questions; });
            CHECK(asked == questions);
            CHECK(cancelled.report.solve.stop == solve::stop::user);
            if (questions >= first) CHECK(cancelled);
            if (cancelled)
            {
                CHECK(cancelled.uv.size() == m.points().size());
                CHECK(certify<2>(m.cells(), cancelled.uv).flipped == 0);
                CHECK(cancelled.report.solve.value >= 4);
                continue;
            }
            CHECK(cancelled.report.outcome == outcome::stopped);
            CHECK(cancelled.uv.empty());
            CHECK(cancelled.reason() == "stopped before there was a map");
        }

        const auto late = parameterize(q, m, {.solve = endless}, {.time_limit = 0s});
        CHECK(late.report.outcome == outcome::stopped);
        CHECK(late.report.solve.stop == solve::stop::time);
        CHECK(late.uv.empty());

        const auto none = parameterize(q, m, {.solve = {.method = method, .max_iterations = 0}});
        CHECK(none);
        CHECK(none.report.solve.iterations == 0);
        for (const auto& level : none.report.levels) CHECK(level.solve.iterations == 0);
    }
}

TEST_CASE("parameterize: unsuitable surfaces are refused with their fault")
{
    queue q(test::shared_context());
    const auto fault_of = [&](const mesh<triangle>& m)
    {
        try
        {
            parameterize(q, m);
        }
        catch (const mesh_error& e)
        {
            return e.fault();
        }
        return mesh_error::empty;
    };
    CHECK(fault_of(test::octahedron()) == mesh_error::closed_surface);
    CHECK(fault_of(test::annulus(12)) == mesh_error::several_boundaries);
    CHECK(fault_of(test::two_components()) == mesh_error::several_components);
    CHECK(parameterize(q, test::annulus(12), {.holes = true, .solve = {.max_iterations = 5}}));
}

TEST_CASE("parameterize: the smallest meshes")
{
    queue q(test::shared_context());
    for (const auto& m : {test::single_triangle(), test::fan(3), test::fan(5, true)})
        for (const auto boundary : {boundary_mode::free, boundary_mode::fixed})
            CHECK(parameterize(q, m, {.boundary = boundary, .solve = {.max_iterations = 20}}));
}

TEST_CASE("parameterize: slivers and long tubes")
{
    queue q(test::shared_context());
    const auto tube = test::tube(test::sized(12, 4), test::sized(8, 1));
    for (const auto method : methods) CHECK(parameterize(q, tube, {.solve = {.method = method, .max_iterations = 30}}));

    auto points = test::grid(6, 6).points();
    for (auto& p : points) p.y *= 1e-6;
    for (const auto method : methods)
        CHECK(parameterize(q, mesh<triangle>(points, test::grid(6, 6).cells()),
                           {.solve = {.method = method, .max_iterations = 30}}));
}

TEST_CASE("parameterize: random disks keep every triangle upright, whatever the iteration limit")
{
    queue q(test::shared_context());
    for (unsigned seed = 0; seed < 12; ++seed)
    {
        const auto m = test::bumpy(3 + static_cast<int>(seed) % test::sized(6, 2), 0.6, seed);
        for (const auto method : methods)
        {
            const int most = method == solve::method::lbfgs ? static_cast<int>(seed * 7) : static_cast<int>(seed);
            const auto r = parameterize(q, m, {.solve = {.method = method, .max_iterations = most}});
            REQUIRE(r);
            CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
            check_falling(r.report.solve, r.report.precision);
        }
    }
}
