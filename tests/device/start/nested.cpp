// SPDX-License-Identifier: MIT
#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include <support/extreme_meshes.hpp>
#include <support/meshes.hpp>
#include <support/mips_power.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/start/nested.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// Enough vertices for levels above the one that the start is made on.
mesh<triangle> hills()
{
    return test::bumpy(test::sized(30, 4), 0.25, 2);
}

/// A grid of n by n quads without one in the middle.
mesh<triangle> with_hole(int n)
{
    auto cells = test::grid_cells(n, n);
    const auto middle = cells.begin() + n * n + (n % 2 == 0 ? n : 0);
    cells.erase(middle, middle + 2);
    return {test::grid(n, n).points(), cells};
}

map_result long_lbfgs(queue& q, const mesh<triangle>& m, parameterize_params p)
{
    p.solve = {.method = solve::method::lbfgs, .gradient_tolerance = 1e-7, .max_iterations = 20000};
    p.precision = precision::fp64;
    return parameterize(q, m, p);
}

/// Certified, converged, and as a report should be.
void check_converged(const mesh<triangle>& m, const map_result& r, double tolerance = 1e-6)
{
    REQUIRE(r);
    CHECK(r.report.flips.flipped == 0);
    CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
    const auto stop = r.report.solve.stop;
    CHECK((stop == solve::stop::gradient || stop == solve::stop::decrement || stop == solve::stop::settled));
    if (stop == solve::stop::gradient) CHECK(r.report.solve.gradient_norm <= tolerance);
    for (const int c : r.report.solve.capping) CHECK((c >= 0 && c < m.cell_count()));
}

/// Where the boundary lies.
std::vector<vec2> outline(const mesh<triangle>& m, const map_result& r)
{
    std::vector<vec2> points;
    const auto loops = boundary_loops(m);
    for (const auto v : loops.front()) points.push_back(r.uv[static_cast<std::size_t>(v)]);
    return points;
}

} // namespace

TEST_CASE("nested: Newton's method finds the minimum of plain BFGS from any start, in double and mixed")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto reference = long_lbfgs(q, m, {});
    REQUIRE(reference);
    for (const auto start :
         {start_method::automatic, start_method::coarse, start_method::barycentric, start_method::conformal})
        for (const auto how : {precision::fp64, precision::mixed})
        {
            CAPTURE(static_cast<int>(start));
            CAPTURE(static_cast<int>(how));
            const auto r = parameterize(q, m, {.start = start, .precision = how});
            check_converged(m, r);
            CHECK(r.report.precision == how);
            CHECK(r.report.notes.empty());
            CHECK(r.report.solve.value == doctest::Approx(reference.report.solve.value).epsilon(1e-6));
            CHECK(measure_quality<triangle>(m, r.uv).isometric.measure ==
                  doctest::Approx(r.report.solve.value).epsilon(1e-6));
            const bool nested = start == start_method::automatic || start == start_method::coarse;
            CHECK(r.report.levels.empty() != (nested && m.points().size() > 1000));
        }
}

TEST_CASE("nested: every energy and weighting ends in one minimum, whatever the start")
{
    using namespace taut::energy;
    queue q(test::shared_context());
    const auto m = hills();
    const std::pair<std::string, any_energy> energies[] = {
        {"isometric", isometric{}},
        {"shape", shape{}},
        {"area", area{}},
        {"a user's", test::mips_power{}},
        {"a sum with a user's", 0.8 * isometric{} + 0.2 * test::mips_power{.p = 3}}};
    for (const auto& tried : energies)
        for (const auto weights : {weighting::uniform, weighting::measure})
        {
            CAPTURE(tried.first);
            CAPTURE(static_cast<int>(weights));
            parameterize_params p{.energy = tried.second, .weights = weights};
            const auto nested = parameterize(q, m, p);
            p.start = start_method::barycentric;
            const auto direct = parameterize(q, m, p);
            // The area energy has many maps of the least value, 2, and no curvature between them.
            if (tried.first == "area")
            {
                REQUIRE(nested);
                REQUIRE(direct);
                CHECK(nested.report.solve.value == doctest::Approx(2).epsilon(1e-5));
                CHECK(direct.report.solve.value == doctest::Approx(2).epsilon(1e-5));
                continue;
            }
            check_converged(m, nested);
            check_converged(m, direct);
            CHECK(nested.report.solve.value == doctest::Approx(direct.report.solve.value).epsilon(1e-5));
        }
}

TEST_CASE("nested: iterations on the mesh itself do not grow with it")
{
    queue q(test::shared_context());
    for (const int n : {test::sized(28, 4), test::sized(56, 5), test::sized(112, 6)})
    {
        const auto m = test::bumpy(n, 0.15, 1);
        CAPTURE(m.cells().size());
        const auto r = parameterize(q, m);
        check_converged(m, r);
        CHECK(r.report.solve.iterations <= 10);
        CHECK(r.report.solve.value < 4.6);
    }
}

TEST_CASE("nested: the report tells of every level")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(96, 5), 0.25, 2);
    std::set<int> seen;
    const auto r = parameterize(q, m, {},
                                {.observer = [&](const taut::progress& p)
                                 {
                                     if (p.iterate) seen.insert(p.level);
                                     return true;
                                 }});
    check_converged(m, r);
    const auto& levels = r.report.levels;
    if (m.points().size() > 9000) REQUIRE(levels.size() >= 2);
    for (std::size_t k = 0; k < levels.size(); ++k)
    {
        CHECK(levels[k].level == levels.size() - k);
        CHECK(levels[k].vertices < m.points().size());
        if (k > 0) CHECK(levels[k].vertices > levels[k - 1].vertices);
        CHECK(levels[k].solve.value <= levels[k].solve.value_start);
        CHECK(levels[k].solve.history.empty());
        CHECK(seen.count(static_cast<int>(levels[k].level)) == 1);
    }
    CHECK(seen.count(0) == 1);
    const auto& history = r.report.solve.history;
    REQUIRE(history.size() == static_cast<std::size_t>(r.report.solve.iterations) + 1);
    CHECK(history.front().value == r.report.solve.value_start);
    CHECK(history.back().value == r.report.solve.value);
    CHECK(r.report.solve.products >= r.report.solve.iterations);
    CHECK(r.report.counters.launches > 0);
    CHECK(r.report.counters.waits > 0);
}

TEST_CASE("nested: twice the same gives the same map, bit for bit")
{
    queue q(test::shared_context());
    const auto m = hills();
    CHECK(parameterize(q, m).uv == parameterize(q, m).uv);
}

TEST_CASE("nested: a fixed boundary is the same outline on every path, and stays bit for bit")
{
    queue q(test::shared_context());
    const auto m = hills();
    for (const auto boundary : {boundary_mode::fixed, boundary_mode::square})
    {
        parameterize_params p{.boundary = boundary};
        const auto r = parameterize(q, m, p);
        check_converged(m, r);
        p.precision = precision::fp64;
        p.solve.max_iterations = 0;
        const auto none = parameterize(q, m, p);
        REQUIRE(none);
        CHECK(outline(m, none) == outline(m, r));

        p.solve.max_iterations = 1000;
        p.start = start_method::barycentric;
        const auto direct = parameterize(q, m, p);
        check_converged(m, direct);
        const auto a = outline(m, r), b = outline(m, direct);
        // A circle may be turned: where it begins is a matter of numbering.
        double difference = 0;
        for (std::size_t k = 0; k < a.size(); ++k)
            difference = std::max({difference, std::abs(glm::length(a[k]) - glm::length(b[k])),
                                   std::abs(glm::length(a[k] - a[0]) - glm::length(b[k] - b[0]))});
        CHECK(difference < 1e-12);
        CHECK(r.report.solve.value == doctest::Approx(direct.report.solve.value).epsilon(1e-6));
    }
}

TEST_CASE("nested: a start of one's own far from the origin keeps its fixed boundary, bit for bit")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(12, 3), 0.3, 2);
    auto start = barycentric_map(m).uv;
    for (auto& p : start) p += vec2(3, -2);
    for (const auto method : {solve::method::newton, solve::method::lbfgs})
    {
        const auto r =
            parameterize(q, m, {.boundary = boundary_mode::fixed, .initial = start, .solve = {.method = method}});
        check_converged(m, r);
        const auto loops = boundary_loops(m);
        for (const auto v : loops.front())
            CHECK(r.uv[static_cast<std::size_t>(v)] == start[static_cast<std::size_t>(v)]);
    }
}

TEST_CASE("nested: surfaces with holes")
{
    queue q(test::shared_context());
    for (const auto& m : {with_hole(test::sized(40, 6)), test::annulus(test::sized(60, 8))})
        for (const auto boundary : {boundary_mode::free, boundary_mode::fixed})
        {
            const auto r = parameterize(q, m, {.boundary = boundary, .holes = true});
            check_converged(m, r);
        }
}

TEST_CASE("nested: the smallest meshes, and meshes of pinned vertices only")
{
    queue q(test::shared_context());
    const mesh<triangle> meshes[] = {test::single_triangle(), test::grid(1, 1),    test::fan(3),
                                     test::fan(5, true),      test::fan(10),       test::fan(10, true),
                                     test::grid(1, 8),        test::fan(60, true), test::grid(2, 40)};
    for (const auto& m : meshes)
        for (const auto boundary : {boundary_mode::free, boundary_mode::fixed})
        {
            CAPTURE(m.cells().size());
            CAPTURE(static_cast<int>(boundary));
            const auto r = parameterize(q, m, {.boundary = boundary});
            REQUIRE(r);
            CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
            CHECK(std::isfinite(r.report.solve.value));
            CHECK(r.report.solve.stop == solve::stop::gradient);
        }
}

TEST_CASE("nested: preconditioned BFGS and conjugate gradients converge, in fewer iterations than without")
{
    queue q(test::shared_context());
    const auto m = hills();
    for (const auto method : {solve::method::lbfgs, solve::method::conjugate_gradient})
    {
        CAPTURE(static_cast<int>(method));
        parameterize_params p{.precision = precision::fp64, .solve = {.method = method, .max_iterations = 5000}};
        const auto plain = parameterize(q, m, p);
        p.multigrid = true;
        // From the plain barycentric map the Hessian of the start would not serve for long.
        const std::pair<start_method, precision> runs[] = {{start_method::coarse, precision::fp64},
                                                           {start_method::coarse, precision::automatic},
                                                           {start_method::tutte, precision::fp64}};
        for (const auto& [start, how] : runs)
        {
            p.start = start;
            CAPTURE(static_cast<int>(p.start));
            p.precision = how;
            const auto r = parameterize(q, m, p);
            check_converged(m, r);
            CHECK(r.report.solve.iterations < plain.report.solve.iterations / 2);
            CHECK(r.report.solve.value == doctest::Approx(plain.report.solve.value).epsilon(1e-6));
        }
    }
}

TEST_CASE("nested: bodies with a short slit converge by default")
{
    queue q(test::shared_context());
    for (const auto& m : {test::slit(test::sphere(test::sized(4, 2)), 2), test::slit(test::animal(24), 5)})
    {
        CAPTURE(m.cells().size());
        check_converged(m, parameterize(q, m));
    }
}

TEST_CASE("nested: levels of a large hard shape grow more slowly, which saves iterations on the mesh itself")
{
    queue q(test::shared_context());
    const auto growth = [](const mesh<triangle>& m, const map_result& r)
    {
        REQUIRE(!r.report.levels.empty());
        return double(m.points().size()) / double(r.report.levels.back().vertices);
    };
    const int n = test::sized(144, 24);
    const auto hard = test::slit(test::animal(n), 2 * n / 3);
    const auto map = parameterize(q, hard);
    check_converged(hard, map);
    const bool large = hard.points().size() >= nested_params::hard_vertices;
    if (large) CHECK(map.report.solve.iterations <= 16); // on levels that grow by eight 20
    CHECK(growth(hard, map) == doctest::Approx(large ? 4 : 8).epsilon(0.1));

    const auto easy = test::bumpy(test::sized(180, 30), 0.15, 1);
    CHECK(growth(easy, parameterize(q, easy)) == doctest::Approx(8).epsilon(0.1));
}

TEST_CASE("nested: a tube 20 times as long as wide converges by default")
{
    queue q(test::shared_context());
    const auto m = test::long_tube(test::sized(12, 6), test::sized(20, 5));
    const auto r = parameterize(q, m);
    check_converged(m, r);
    // However it ended, a tighter tolerance gains nothing to speak of.
    const auto tighter = parameterize(q, m, {.solve = {.gradient_tolerance = 1e-9}});
    const bool settled = r.report.solve.stop == solve::stop::settled;
    CHECK(r.report.solve.value <= tighter.report.solve.value * (1 + (settled ? 1e-4 : 1e-7)));
}

TEST_CASE("nested: the longest tubes get a certified map of moderate distortion by default")
{
    queue q(test::shared_context());
    const std::pair<mesh<triangle>, double> tubes[] = {{test::long_tube(test::sized(12, 6), test::sized(90, 5)), 500},
                                                       {test::coiled_tube(test::sized(12, 6), test::sized(3, 1)), 200}};
    for (const auto& tube : tubes)
    {
        const auto& m = tube.first;
        CAPTURE(m.cells().size());
        // Their many minima lie in long flat valleys; not every path to one ends within the iterations.
        const auto r = parameterize(q, m, {.solve = {.max_iterations = 40}});
        REQUIRE(r);
        CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
        CHECK(r.report.solve.value < tube.second);
    }
}

TEST_CASE("nested: a caller who stops a run gets a certified map from the finest level on, and is not asked again")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(50, 5), 0.5, 3);
    const auto whole = parameterize(q, m);
    REQUIRE(whole);
    const int levels = static_cast<int>(whole.report.levels.size());
    for (int level = levels; level >= 0; --level)
        for (const int steps : {0, 2})
        {
            CAPTURE(level);
            CAPTURE(steps);
            int refused = 0;
            const auto r = parameterize(q, m, {},
                                        {.observer = [&](const taut::progress& p)
                                         {
                                             if (p.level != level || p.evaluations == 0 || p.iteration < steps)
                                                 return true;
                                             ++refused;
                                             return false;
                                         }});
            if (refused > 0)
            {
                CHECK(refused == 1);
                CHECK(r.report.solve.stop == solve::stop::user);
                CHECK(static_cast<bool>(r) == (level == 0));
                CHECK(r.uv.empty() == (level > 0));
            }
            if (!r) continue;
            CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
            // What is reported is the energy of the map that is returned.
            CHECK(measure_quality<triangle>(m, r.uv).isometric.measure ==
                  doctest::Approx(r.report.solve.value).epsilon(1e-6));
        }
}

TEST_CASE("nested: a stop in any phase leaves a certified map or none")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(50, 5), 0.5, 3);
    int asked = 0, last = 0;
    const auto count = [&](const taut::progress&) { return ++asked, true; };
    REQUIRE(parameterize(q, m, {}, {.observer = count}));
    for (int k = 0; k <= 10; ++k)
    {
        last = 1 + k * (asked - 2) / 10; // not the last one, which need not be minded
        bool usable = false;
        int now = 0;
        const auto stop = [&](const taut::progress& p) { return usable = p.usable, ++now < last; };
        const auto r = parameterize(q, m, {}, {.observer = stop});
        if (usable) CHECK(r);
        CHECK(r.report.outcome == (r ? outcome::valid : outcome::stopped));
        CHECK(r.report.solve.stop == solve::stop::user);
        if (r) CHECK(certify<2>(m.cells(), r.uv).flipped == 0);
        if (!r) CHECK(r.uv.empty());
    }
}
