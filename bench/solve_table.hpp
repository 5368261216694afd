// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "solver_run.hpp"

namespace bench
{

/// Relative errors of the energy whose effort is told.
inline constexpr std::array<double, 3> targets = {1e-2, 1e-3, 1e-6};

/// All runs of one solver on one mesh, and what is told of them: medians over the runs.
struct solver_result
{
    std::string name;
    std::vector<solver_run> runs;

    /// Median effort to an energy; none where half of the runs did not get there.
    std::optional<reached> to(double best, double error) const
    {
        std::vector<int> iterations;
        std::vector<double> seconds;
        for (const auto& r : runs)
        {
            const auto e = effort(r, best, error);
            iterations.push_back(e ? e->iterations : std::numeric_limits<int>::max());
            seconds.push_back(e ? e->seconds : std::numeric_limits<double>::infinity());
        }
        const auto t = *median(seconds);
        if (!std::isfinite(t)) return std::nullopt;
        return reached{*median(iterations), t};
    }

    double lowest() const
    {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& r : runs)
            if (r.valid && r.flipped == 0) least = std::min(least, r.energy);
        return least;
    }

    template <class Figure>
    auto of(Figure&& figure) const
    {
        return median_of(runs, figure);
    }

    /// Bytes a second while solving.
    std::optional<double> rate() const
    {
        if (!runs.front().bytes_moved) return std::nullopt;
        return of([](const solver_run& r) { return static_cast<double>(*r.bytes_moved) / r.seconds.solve; });
    }
};

/// One mesh on one level of subdivision.
struct mesh_result
{
    std::string name;
    int level = 0;
    std::size_t faces = 0, vertices = 0;
    double best = 0; ///< energy that errors refer to
    std::vector<solver_result> solvers;
};

inline void print(const mesh_result& m, double triad)
{
    std::printf("\n%s, level %d: %zu triangles, best energy %.10g\n", m.name.c_str(), m.level, m.faces, m.best);
    std::printf("%-15s|       to 1 %%      to 0.1 %%       to 1e-6 |   end  %%error  its  stop\n", "its and seconds");
    for (const auto& s : m.solvers)
    {
        std::printf("%-15s|", s.name.c_str());
        for (const double error : targets)
            if (const auto e = s.to(m.best, error))
                std::printf(" %5d %7.3f", e->iterations, e->seconds);
            else
                std::printf("     -       -");
        const auto& last = s.runs.back();
        std::printf(" | %7.3f %7.1e %5d  %s%s\n", s.of([](const solver_run& r) { return r.seconds.total(); }),
                    100 * (last.energy / m.best - 1), last.iterations, last.stop.c_str(),
                    last.flipped ? ", FLIPPED" : "");
    }
    std::printf("%-15s|  read device  hier. start  other  solve |    CPU  runs |  waits launches  read/write MB "
                "| moved GB/s of triad | peak MB above\n",
                "seconds");
    for (const auto& s : m.solvers)
    {
        const auto phase = [&](double phases::*p) { return s.of([p](const solver_run& r) { return r.seconds.*p; }); };
        const auto count = [&](std::uint64_t taut::queue_counters::*c)
        { return static_cast<double>(s.of([c](const solver_run& r) { return r.counters.*c; })); };
        std::printf("%-15s| %5.3f %6.3f %6.3f %5.3f %6.3f %6.3f | %6.2f  %4zu |", s.name.c_str(), phase(&phases::read),
                    phase(&phases::device), phase(&phases::hierarchy), phase(&phases::start), phase(&phases::other),
                    phase(&phases::solve), s.of([](const solver_run& r) { return r.cpu_seconds; }), s.runs.size());
        std::printf(" %6.0f %8.0f %6.1f %8.1f |", count(&taut::queue_counters::waits),
                    count(&taut::queue_counters::launches), count(&taut::queue_counters::bytes_read) * 1e-6,
                    count(&taut::queue_counters::bytes_written) * 1e-6);
        if (const auto rate = s.rate())
            std::printf(" %10.2f %6.0f %% |", *rate * 1e-9, 100 * *rate / triad);
        else
            std::printf("          -        - |");
        const auto peak = [](const solver_run& r) { return r.peak_bytes; };
        const auto above = [](const solver_run& r) { return r.peak_bytes - std::min(r.peak_bytes, r.bytes_before); };
        std::printf(" %7.0f %5.0f\n", static_cast<double>(s.of(peak)) * 1e-6, static_cast<double>(s.of(above)) * 1e-6);
    }
    std::fflush(stdout);
}

/// The curve of a run, with as many points as a plot needs: each below the last by 2 % of its error at the least.
inline nlohmann::ordered_json curve(const solver_run& run, double best)
{
    auto points = nlohmann::ordered_json::array();
    double error = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < run.history.size(); ++i)
    {
        const auto& s = run.history[i];
        const double e = s.value / best - 1;
        if (i > 0 && i + 1 < run.history.size() && !(e < 0.98 * error)) continue;
        error = e;
        points.push_back({{"seconds", s.seconds}, {"value", s.value}, {"error", e}, {"iteration", s.iteration}});
    }
    return points;
}

inline nlohmann::ordered_json to_json(const solver_result& s, double best)
{
    const auto phase = [&](double phases::*p) { return s.of([p](const solver_run& r) { return r.seconds.*p; }); };
    const auto& last = s.runs.back();
    nlohmann::ordered_json json = {{"solver", s.name},
                                   {"runs", s.runs.size()},
                                   {"iterations", last.iterations},
                                   {"evaluations", last.evaluations},
                                   {"energy", last.energy},
                                   {"flipped", last.flipped},
                                   {"stop", last.stop}};
    auto& to = json["to"] = nlohmann::ordered_json::array();
    for (const double error : targets)
        if (const auto e = s.to(best, error))
            to.push_back({{"error", error}, {"iterations", e->iterations}, {"seconds", e->seconds}});
    json["seconds"] = {{"read", phase(&phases::read)},
                       {"device", phase(&phases::device)},
                       {"hierarchy", phase(&phases::hierarchy)},
                       {"start", phase(&phases::start)},
                       {"other", phase(&phases::other)},
                       {"solve", phase(&phases::solve)},
                       {"total_less_device", s.of([](const solver_run& r) { return r.seconds.total(); })},
                       {"cpu", s.of([](const solver_run& r) { return r.cpu_seconds; })}};
    const auto& c = last.counters;
    if (c.launches > 0)
        json["queue"] = {{"launches", c.launches},
                         {"waits", c.waits},
                         {"bytes_read", c.bytes_read},
                         {"bytes_written", c.bytes_written}};
    if (last.bytes_moved) json["bytes_moved_by_elements"] = *last.bytes_moved;
    if (const auto rate = s.rate()) json["bytes_a_second"] = *rate;
    json["peak_bytes"] = s.of([](const solver_run& r) { return r.peak_bytes; });
    json["peak_bytes_before"] = s.of([](const solver_run& r) { return r.bytes_before; });
    json["history"] = curve(last, best);
    return json;
}

inline nlohmann::ordered_json to_json(const mesh_result& m)
{
    nlohmann::ordered_json json = {
        {"mesh", m.name}, {"level", m.level}, {"faces", m.faces}, {"vertices", m.vertices}, {"best", m.best}};
    auto& solvers = json["solvers"] = nlohmann::ordered_json::array();
    for (const auto& s : m.solvers) solvers.push_back(to_json(s, m.best));
    return json;
}

} // namespace bench
