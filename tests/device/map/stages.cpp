// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>
#include <support/stage_watch.hpp>

#include <taut/deform.hpp>
#include <taut/parameterize.hpp>

namespace
{

using namespace taut;

mesh<triangle> bumps()
{
    return test::rings(test::sized(40, 24),
                       [](double r, double angle)
                       {
                           const double x = r * std::cos(angle), y = r * std::sin(angle);
                           return vec3(x, y, 0.2 * std::sin(6 * x) * std::cos(5 * y));
                       });
}

int iterations(const std::vector<taut::stage_report>& stages, const std::string& name, bool finest)
{
    int sum = 0;
    for (const auto& s : stages)
        if (s.stage == name && (s.level == 0) == finest) sum += s.iterations;
    return sum;
}

TEST_CASE("stages: of a free map from coarse to fine, complete, with the energies and steps of the levels")
{
    queue q(test::shared_context());
    const auto m = bumps();
    test::stage_watch watch;
    const auto r = parameterize(q, m, {}, {.observer = watch.observer()});
    REQUIRE(r);
    const auto& stages = r.report.stages;
    watch.check_complete(stages);

    CHECK(stages.front().stage == "setup");
    CHECK(stages.back().stage == "certify");
    CHECK(iterations(stages, "minimise", true) == r.report.solve.iterations);
    int coarse = 0;
    for (const auto& l : r.report.levels) coarse += l.solve.iterations;
    CHECK(iterations(stages, "minimise", false) == coarse);

    std::size_t reinserted = 0, level = std::size_t(-1);
    const taut::stage_report* before = nullptr;
    for (const auto& s : stages)
    {
        if (s.stage != "reinsert" && s.stage != "minimise") continue;
        CHECK(s.level <= level);
        level = s.level;
        CHECK(s.energy_after <= s.energy_before * (1 + 1e-12));
        CHECK(s.energy_after >= 4 * (1 - 1e-9));
        if (s.stage == "reinsert")
        {
            ++reinserted;
            CHECK((before && before->level == s.level + 1));
        }
        else
        {
            CHECK(!s.stop.empty());
            if (s.iterations > 0) CHECK((s.step_median > 0 && s.step_median <= 1));
        }
        before = &s;
    }
    CHECK(reinserted == r.report.levels.size());
    CHECK(level == 0);
    CHECK(before->energy_after == r.report.solve.value);
    CHECK(before->vertices == m.points().size());
}

TEST_CASE("stages: of a map without levels, and of pins that are drawn or untangled")
{
    queue q(test::shared_context());
    const auto m = bumps();
    const auto plain =
        parameterize(q, m, {.start = start_method::barycentric, .solve = {.method = solve::method::lbfgs}});
    REQUIRE(plain);
    for (const auto& s : plain.report.stages) CHECK(s.level == 0);
    CHECK(iterations(plain.report.stages, "minimise", true) == plain.report.solve.iterations);

    const auto free = parameterize(q, m).uv;
    auto pins = constraints(m).fix(boundary_loops(m).front(), free);
    pins.pin(0, free[0] + vec2(0.05, 0.02));
    for (const bool coarse : {true, false})
    {
        test::stage_watch watch;
        const auto start = coarse ? start_method::automatic : start_method::barycentric;
        const auto r = parameterize(q, m, {.constraints = pins, .start = start}, {.observer = watch.observer()});
        REQUIRE(r);
        watch.check_complete(r.report.stages);
        int drawn = 0, proved = 0;
        for (const auto& s : r.report.stages)
        {
            drawn += s.stage == "draw";
            proved += s.stage == "proofs" && s.level == 0;
        }
        CHECK(drawn == coarse);
        CHECK(proved == !coarse);
        CHECK(iterations(r.report.stages, "minimise", true) == r.report.solve.iterations);
    }
}

TEST_CASE("stages: a barrier that cuts steps names the vertices of the elements that did")
{
    queue q(test::shared_context());
    const auto m = test::rings(8, [](double r, double angle)
                               { return vec3(r * std::cos(angle), r * std::sin(angle), 20 * r * r); });
    const auto r = parameterize(q, m, {.start = start_method::barycentric, .solve = {.max_iterations = 1}});
    REQUIRE(r);
    const auto& stages = r.report.stages;
    const auto last = std::find_if(stages.rbegin(), stages.rend(), [](const auto& s) { return s.stage == "minimise"; });
    REQUIRE(last != stages.rend());
    CHECK(last->steps_cut == static_cast<int>(!r.report.solve.capping.empty()));
    CHECK(last->cut_by.empty() == r.report.solve.capping.empty());
    for (const int c : r.report.solve.capping)
        for (const idx v : m.cells()[static_cast<std::size_t>(c)])
            CHECK(std::binary_search(last->cut_by.begin(), last->cut_by.end(), v));
}

TEST_CASE("stages: of a shape whose pins move, and of one that is untangled first")
{
    queue q(test::shared_context());
    const auto m = test::grid(12, 12);
    auto pins = constraints(m).pin(0, vec2(0, 0)).pin(m.vertex_count() - 1, vec2(m.points().back()) + vec2(0.1, 0.2));
    auto initial = std::vector<vec2>(m.points().begin(), m.points().end());
    for (const bool tangled : {false, true})
    {
        if (tangled) std::swap(initial[40], initial[100]);
        test::stage_watch watch;
        const auto r =
            deform<triangle>(q, m, {.constraints = pins, .initial = initial}, {.observer = watch.observer()});
        REQUIRE(r);
        watch.check_complete(r.report.stages);
        int steps = 0;
        bool margin = false;
        for (const auto& s : r.report.stages)
        {
            if (s.stage == "follow" || s.stage == "repair" || s.stage == "minimise") steps += s.iterations;
            margin = margin || s.stage == "margin";
        }
        CHECK(steps == r.report.steps);
        CHECK(margin == tangled);
    }
}

} // namespace
