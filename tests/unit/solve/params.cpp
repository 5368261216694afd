// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <string>

using namespace taut::solve;
using namespace taut::solve::impl;

TEST_CASE("params: the defaults are valid")
{
    CHECK_NOTHROW(params{}.validate());
    CHECK_NOTHROW(descent_params{}.validate());
    const stopping_params usual, asked = params{}.common().stopping;
    CHECK(asked.gradient_tolerance == usual.gradient_tolerance);
    CHECK(asked.decrease_tolerance == usual.decrease_tolerance);
    CHECK(asked.max_iterations == usual.max_iterations);
}

TEST_CASE("params: a bad field is named, also by minimize")
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::pair<std::string, std::function<void(params&)>>> cases{
        {"gradient_tolerance", [](params& p) { p.gradient_tolerance = -1; }},
        {"stopping.settled_tolerance", [](params& p) { p.tuning.stopping.settled_tolerance = 1; }},
        {"decrease_tolerance", [&](params& p) { p.decrease_tolerance = nan; }},
        {"stopping.step_tolerance", [](params& p) { p.tuning.stopping.step_tolerance = 1; }},
        {"stopping.decrease_count", [](params& p) { p.tuning.stopping.decrease_count = 0; }},
        {"stopping.barrier_count", [](params& p) { p.tuning.stopping.barrier_count = 0; }},
        {"max_iterations", [](params& p) { p.max_iterations = -1; }},
        {"wolfe.sufficient_decrease", [](params& p) { p.tuning.line.wolfe.sufficient_decrease = 0.5; }},
        {"wolfe.curvature", [](params& p) { p.tuning.line.wolfe.curvature = 1e-5; }},
        {"exact.tolerance", [](params& p) { p.tuning.line.exact.tolerance = 0; }},
        {"exact.evaluations", [](params& p) { p.tuning.line.exact.evaluations = -1; }},
        {"exact.first_tolerance", [](params& p) { p.tuning.line.exact.first_tolerance = 1; }},
        {"exact.first_evaluations", [](params& p) { p.tuning.line.exact.first_evaluations = -1; }},
        {"exact.growth", [](params& p) { p.tuning.line.exact.growth = 1; }},
        {"exact.bracket_passes", [](params& p) { p.tuning.line.exact.bracket_passes = 0; }},
        {"line_search.barrier_fraction", [](params& p) { p.tuning.line.barrier_fraction = 1; }},
        {"line_search.batch", [](params& p) { p.tuning.line.batch = 17; }},
        {"line_search.max_evaluations", [](params& p) { p.tuning.line.max_evaluations = 0; }},
        {"line_search.shrink", [](params& p) { p.tuning.line.shrink = 1; }},
        {"line_search.rounding", [](params& p) { p.tuning.line.rounding = -1e-16; }},
        {"memory.pairs", [](params& p) { p.tuning.lbfgs.memory.pairs = 65; }},
        {"memory.cautious", [](params& p) { p.tuning.conjugate_gradient.memory.cautious = 1; }},
        {"conjugate_gradient.restart_interval", [](params& p) { p.tuning.conjugate_gradient.restart_interval = -1; }},
        {"newton.exact_below", [](params& p) { p.tuning.newton.exact_below = 1; }},
        {"newton.relax_below", [&](params& p) { p.tuning.newton.relax_below = nan; }},
        {"newton.eliminate_from", [](params& p) { p.tuning.newton.eliminate_from = 0; }},
        {"newton.eliminate_below", [&](params& p) { p.tuning.newton.eliminate_below = nan; }},
        {"newton.eliminate_above", [](params& p) { p.tuning.newton.eliminate_above = 0; }},
        {"pcg.max_steps", [](params& p) { p.tuning.newton.pcg.max_steps = 0; }},
        {"pcg.block", [](params& p) { p.tuning.newton.pcg.block = 0; }},
        {"pcg.gain", [](params& p) { p.tuning.newton.pcg.gain = 0; }},
        {"method", [](params& p) { p.method = method::newton; }}, // f has no Hessian
        {"first_length", [](params& p) { p.tuning.first_length = 0; }},
    };
    auto f = functions::quadratic(2, 2);
    for (const auto& wrong : cases)
    {
        const auto& field = wrong.first;
        CAPTURE(field);
        params p;
        wrong.second(p);
        std::vector<double> x(2);
        try
        {
            minimize(f, x, p);
            FAIL_CHECK("accepted");
        }
        catch (const taut::parameter_error& e)
        {
            CHECK(e.field() == field);
        }
    }
}
