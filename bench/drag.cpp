// SPDX-License-Identifier: MIT
// Dragging pins of a map that stays open: four vertices of the boundary are pinned where the free map has them, and 1
// or 20 inside are led around circles, a turn a second at 60 frames a second, until they rest. What a frame takes, by
// phase; how far the map moves in one; and the energy ten frames after the pins rest, against a map from scratch.
//   taut_bench_drag [--frames N] [--rest N] [--steps N] [--time MS] [--radius R] [--json FILE] [MESH...]
// steps, time: the budget of a frame. radius: of the circle of one pin, by the longer side of the map's box; of n pins
// 1 / sqrt(n) of it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <numbers>
#include <vector>

#include <support/meshes.hpp>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>
#include <taut/parameterize.hpp>
#include <taut/session.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

struct setting
{
    int frames = 100, rest = 10;
    session_budget budget;
    double radius = 0.05;
};

double at_rank(std::vector<double> values, double part)
{
    std::sort(values.begin(), values.end());
    return values.empty() ? 0
                          : values[std::min(values.size() - 1, static_cast<std::size_t>(part * double(values.size())))];
}

double extent(const std::vector<vec2>& uv)
{
    vec2 low = uv.front(), high = low;
    for (const vec2& p : uv) low = glm::min(low, p), high = glm::max(high, p);
    return std::max(high.x - low.x, high.y - low.y);
}

/// So many vertices, each as far as can be from `from` and those before it.
std::vector<idx> spread_out(const std::vector<vec2>& uv, const std::vector<idx>& from, int count)
{
    std::vector<double> distance(uv.size(), INFINITY);
    const auto approach = [&](idx v)
    {
        for (std::size_t w = 0; w < uv.size(); ++w)
            distance[w] = std::min(distance[w], glm::distance(uv[w], uv[static_cast<std::size_t>(v)]));
    };
    for (const idx v : from) approach(v);
    std::vector<idx> chosen;
    while (static_cast<int>(chosen.size()) < count)
    {
        chosen.push_back(static_cast<idx>(std::max_element(distance.begin(), distance.end()) - distance.begin()));
        approach(chosen.back());
    }
    return chosen;
}

double longest_move(const std::vector<vec2>& a, const std::vector<vec2>& b)
{
    double most = 0;
    for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, glm::distance(a[v], b[v]));
    return most;
}

/// Phases of a frame, with their names.
constexpr std::pair<const char*, double session_seconds::*> phases[] = {{"constrain", &session_seconds::constrain},
                                                                        {"follow", &session_seconds::follow},
                                                                        {"repair", &session_seconds::repair},
                                                                        {"solve", &session_seconds::solve},
                                                                        {"certificate", &session_seconds::certificate}};

void measure(queue& q, const std::string& name, const mesh<triangle>& m, int pins, const setting& how,
             nlohmann::ordered_json& results)
{
    session s(q, m);
    auto [uv, first] = s.solve();
    if (uv.empty()) throw std::runtime_error(name + ": no free map: " + first.reason);
    const double size = extent(uv), radius = how.radius * size / std::sqrt(double(pins)); // as pins are apart
    const auto boundary = boundary_loops(m).front();
    for (std::size_t k = 0; k < 4; ++k)
    {
        const idx v = boundary[k * boundary.size() / 4];
        s.pin(v, uv[static_cast<std::size_t>(v)]);
    }
    const auto moved = spread_out(uv, boundary, pins);
    const auto origins = uv;
    const auto lead = [&](int frame)
    {
        std::vector<vec2> places;
        for (std::size_t k = 0; k < moved.size(); ++k)
        {
            const double phase = 2 * std::numbers::pi * double(k) / double(moved.size()),
                         angle = phase + 2 * std::numbers::pi * frame / 60;
            places.push_back(origins[static_cast<std::size_t>(moved[k])] +
                             radius * vec2(std::cos(angle) - std::cos(phase), std::sin(angle) - std::sin(phase)));
        }
        s.move(moved, places);
    };
    lead(0);
    s.solve({.steps = 1}); // who is held, and what drivers compile late

    std::vector<double> seconds;
    std::vector<std::vector<double>> by_phase(std::size(phases));
    double jump = 0, last_energy = 0;
    int held = 0, rested = -1;
    for (int frame = 1; frame <= how.frames + how.rest; ++frame)
    {
        if (frame <= how.frames) lead(frame);
        const auto before = s.x();
        session_result<triangle> r;
        const double t = bench::seconds([&] { r = s.solve(how.budget); });
        jump = std::max(jump, longest_move(before, r.x));
        last_energy = r.report.energy;
        if (frame > how.frames && r.report.converged && rested < 0) rested = frame - how.frames;
        if (frame > how.frames) continue;
        held += r.report.pins_held;
        seconds.push_back(t);
        for (std::size_t p = 0; p < std::size(phases); ++p) by_phase[p].push_back(r.report.seconds.*phases[p].second);
    }
    map_result scratch;
    const double whole = bench::seconds([&] { scratch = parameterize(q, m, {.constraints = s.constraints()}); });

    const double step = 2 * radius * std::sin(std::numbers::pi / 60),
                 above = last_energy / scratch.report.solve.value - 1;
    std::printf("%-14s %8zu %5d %7.1f %7.1f", name.c_str(), m.cells().size(), pins, 1e3 * at_rank(seconds, 0.5),
                1e3 * at_rank(seconds, 0.95));
    nlohmann::ordered_json split;
    for (std::size_t p = 0; p < std::size(phases); ++p)
    {
        split[phases[p].first] = at_rank(by_phase[p], 0.5);
        std::printf(" %7.1f", 1e3 * at_rank(by_phase[p], 0.5));
    }
    std::printf(" %5d/%d %6.1f %10.2e %6d %9.0f\n", held, how.frames, jump / step, above, rested, 1e3 * whole);
    std::fflush(stdout);
    results.push_back({{"mesh", name},
                       {"triangles", m.cells().size()},
                       {"pins", pins},
                       {"median", at_rank(seconds, 0.5)},
                       {"rank95", at_rank(seconds, 0.95)},
                       {"phases", split},
                       {"held", held},
                       {"longest_move", jump / step},
                       {"energy", last_energy},
                       {"energy_from_scratch", scratch.report.solve.value},
                       {"frames_to_convergence", rested},
                       {"from_scratch", whole}});
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--frames", "--rest", "--steps", "--time", "--radius"});
    setting how;
    how.frames = std::stoi(options.value("--frames", options.quick ? "6" : "100"));
    how.rest = std::stoi(options.value("--rest", "10"));
    how.budget.steps = std::stoi(options.value("--steps", "2"));
    how.budget.time = std::chrono::duration<double>(1e-3 * std::stod(options.value("--time", "1e9")));
    how.radius = std::stod(options.value("--radius", "0.05"));
    queue q;
    auto report = bench::circumstances(q);
    std::printf(
        "taut %s %s on %s\nmilliseconds a frame: median, 95th percentile, medians of phases; frames with the pins "
        "at their places; the longest move of\na vertex in a frame, by that of a pin; energy after %d frames at "
        "rest, above a map from scratch; frames until converged\n\n",
        TAUT_VERSION_STRING, TAUT_BENCH_COMMIT, q.device().name().c_str(), how.rest);
    std::printf("%-14s %8s %5s %7s %7s", "mesh", "faces", "pins", "median", "95 %");
    for (const auto& p : phases) std::printf(" %7.7s", p.first);
    std::printf(" %9s %6s %10s %6s %9s\n", "held", "move", "above", "conv.", "scratch");
    for (const int pins : {1, 20})
    {
        for (const std::filesystem::path path : options.paths)
            measure(q, path.stem().string(), io::read_surface(path), pins, how, report["results"]);
        if (options.paths.empty())
            measure(q, "generated", test::bumpy(options.quick ? 12 : 40), pins, how, report["results"]);
    }
    options.write(report);
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
