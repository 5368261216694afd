// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_batch.hpp>
#include <taut/impl/charts/atlas/flatten_charts.hpp>
#include <taut/impl/core/compute/queue_counters.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/solve/stop.hpp>
#include <taut/parameterize.hpp>

namespace taut
{

void flatten_params::validate() const
{
    if (!(tolerance >= 1e-12 && tolerance <= 1)) throw parameter_error("tolerance", "must be 1e-12 to 1");
    if (max_iterations < 0) throw parameter_error("max_iterations", "must not be negative");
    if (!(tuning.largest >= 0)) throw parameter_error("largest", "must not be negative");
}

} // namespace taut

namespace taut::impl
{

/// One call of flatten_charts.
class flattening
{
public:
    flattening(queue& q, const chart_mesh& charts, const flatten_params& params, const run_limits& limits)
        : queue_(q),
          charts_(charts),
          params_(params),
          clock_(limits.time_limit, limits.observer),
          work_(u(charts.charts()))
    {
        result_.charts.resize(work_.size());
        result_.uv.assign(charts.surface.points().size(), vec2(0.0));
    }

    flattened_charts run()
    {
        prepare();
        minimize();
        map_large();
        certify();
        return std::move(result_);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Working state of a chart.
    struct chart_work
    {
        std::optional<single_chart> chart;
        std::optional<panel_profile> profile;
        std::optional<ideal_elements<triangle>> ideal; ///< none: the chart has a flat triangle, or is large
        std::vector<vec2> uv;                          ///< in units of the chart; empty: it has no map
        double energy = 0;
    };

    /// Calls work(i) for i below n, in parallel, pieces of them between questions to the clock.
    template <class Work>
    void for_each(std::size_t n, const Work& work)
    {
        constexpr std::size_t piece = 512;
        for (std::size_t first = 0; first < n && proceed(); first += piece)
            parallel_for(
                std::min(piece, n - first),
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t i = begin; i < end; ++i) work(first + i);
                },
                0, 1);
    }

    bool proceed()
    {
        double sum = 0;
        idx mapped = 0;
        for (std::size_t k = 0; k < work_.size(); ++k)
            if (!work_[k].uv.empty())
            {
                sum += work_[k].energy * static_cast<double>(cells(k));
                mapped += static_cast<idx>(cells(k));
            }
        return clock_.proceed({.iteration = done_, .value = mapped > 0 ? sum / mapped : 0.0, .usable = mapped > 0});
    }

    /// Orders all charts and computes their initial maps.
    void prepare()
    {
        for_each(work_.size(),
                 [&](std::size_t k)
                 {
                     chart_work& w = work_[k];
                     chart_report& report = result_.charts[k];
                     w.chart = single_chart::of(charts_, static_cast<idx>(k));
                     w.profile.emplace(vertex_neighbours(w.chart->surface));
                     report.multigrid = w.profile->work > 1e6 * params_.tuning.largest;
                     if (report.multigrid) return;
                     try
                     {
                         w.ideal.emplace(w.chart->surface);
                         auto start = chart_start::of(w.chart->surface, *w.ideal, given(k));
                         report.start_energy = w.energy = start.energy;
                         w.uv = std::move(start.uv);
                     }
                     catch (const error& e)
                     {
                         report.outcome = chart_outcome::no_map;
                         report.reason = e.what();
                     }
                 });
        result_.seconds.start = clock_.lap();
    }

    /// Initial map of a chart as given by the user, in its units.
    std::vector<vec2> given(std::size_t k) const
    {
        if (params_.initial.empty()) return {};
        const auto part = params_.initial.subspan(u(charts_.first_vertex[k]),
                                                  u(charts_.first_vertex[k + 1] - charts_.first_vertex[k]));
        std::vector<vec2> uv(part.begin(), part.end());
        for (vec2& p : uv) p *= work_[k].chart->unit;
        return uv;
    }

    /// Whether an energy is the least there is but for rounding, which steps would follow along thin strips.
    static bool is_isometry(double energy) { return energy < 4 + 1e-9; }

    /// Runs Newton's method in batches that fit the memory of a device.
    void minimize()
    {
        std::vector<std::size_t> by_size;
        for (std::size_t k = 0; k < work_.size(); ++k)
        {
            if (work_[k].uv.empty()) continue;
            if (params_.max_iterations > 0 && is_isometry(work_[k].energy))
            {
                result_.charts[k].outcome = chart_outcome::converged;
                ++done_;
            }
            else
                by_size.push_back(k);
        }
        if (params_.max_iterations == 0)
            for (const std::size_t k : by_size) result_.charts[k].outcome = chart_outcome::iterations;
        if (by_size.empty() || params_.max_iterations == 0 || clock_.over()) return;
        std::stable_sort(by_size.begin(), by_size.end(),
                         [&](std::size_t a, std::size_t b) { return cells(a) > cells(b); });

        const chart_kernel program(queue_);
        result_.seconds.device = clock_.lap();
        const std::size_t most = program.team == 1 ? std::size_t{1} << 15 : std::size_t{1} << 18;
        for (std::size_t first = 0, last = 0; first < by_size.size() && !clock_.over(); first = last)
        {
            std::size_t count = 0;
            while (last < by_size.size() && (last == first || count + cells(by_size[last]) <= most))
                count += cells(by_size[last++]);
            minimize(program, std::span(by_size).subspan(first, last - first));
        }
    }

    void minimize(const chart_kernel& program, std::span<const std::size_t> some)
    {
        std::vector<std::optional<chart_problem>> made(some.size());
        for_each(some.size(),
                 [&](std::size_t j)
                 {
                     chart_work& w = work_[some[j]];
                     made[j] = chart_problem::of(w.chart->surface, *w.ideal, std::move(*w.profile), w.uv);
                 });
        if (clock_.over()) return;
        std::vector<chart_problem> problems;
        for (auto& problem : made) problems.push_back(std::move(*problem));
        chart_batch batch(queue_, program, problems);
        result_.seconds.prepare += clock_.lap();

        std::vector<char> at_work(some.size(), 1);
        for (int i = 1; i <= params_.max_iterations; ++i)
        {
            const std::size_t left = batch.step(params_.tolerance);
            for (std::size_t j = 0; j < some.size(); ++j)
            {
                if (!at_work[j]) continue;
                chart_report& report = result_.charts[some[j]];
                report.iterations = i;
                work_[some[j]].energy = batch.energy(j);
                report.outcome = i < params_.max_iterations ? chart_outcome::stopped : chart_outcome::iterations;
                if (batch.state_of(j) == chart_batch::going) continue;
                at_work[j] = 0;
                report.outcome =
                    batch.state_of(j) == chart_batch::converged ? chart_outcome::converged : chart_outcome::stuck;
                ++done_;
            }
            if (left == 0 || !proceed()) break;
        }
        auto maps = batch.maps();
        for (std::size_t j = 0; j < some.size(); ++j) work_[some[j]].uv = std::move(maps[j]);
        result_.seconds.solve += clock_.lap();
    }

    /// Solves the large charts, one by one.
    void map_large()
    {
        for (std::size_t k = 0; k < work_.size(); ++k)
            if (result_.charts[k].multigrid && proceed()) map_large(k);
        result_.seconds.large = clock_.lap();
    }

    void map_large(std::size_t k)
    {
        chart_report& report = result_.charts[k];
        parameterize_params params{.initial = given(k), .holes = true};
        // A chart that takes long on coarser levels already is none that could be flattened well.
        int steps = 0;
        const auto ask = [&](const progress& p)
        {
            steps += p.iterate ? 1 : 0;
            return steps <= 4 * params_.max_iterations && proceed();
        };
        params.solve.max_iterations = params_.max_iterations;
        if (params_.tuning.rough)
        {
            params.start = start_method::barycentric;
            params.tuning.stretch_rounds = 1;
            params.precision = rough_precision(queue_);
            params.solve = rough_solve(params_.max_iterations);
        }
        try
        {
            const auto& surface = work_[k].chart->surface;
            const ideal_elements<triangle> ideal(surface);
            chart_start start;
            start.consider(surface, ideal, std::move(params.initial));
            params.initial = start.uv;
            start.consider(surface, ideal, unfolded(surface, facets(surface)));
            if (is_isometry(start.energy))
            {
                work_[k].uv = std::move(start.uv);
                report.outcome = chart_outcome::converged;
                ++done_;
                return;
            }
            auto map = parameterize(queue_, surface, params, {clock_.left(), ask});
            report.iterations = static_cast<int>(map.report.solve.iterations);
            report.reason = map.reason();
            if (map) start.consider(surface, ideal, std::move(map.uv)); // in single precision it may be the worse one
            work_[k].uv = std::move(start.uv);
            report.outcome = work_[k].uv.empty()                             ? chart_outcome::no_map
                             : solve::impl::converged(map.report.solve.stop) ? chart_outcome::converged
                             : clock_.over()                                 ? chart_outcome::stopped
                             : steps >= params_.max_iterations               ? chart_outcome::iterations
                                                                             : chart_outcome::stuck;
        }
        catch (const device_error&)
        {
            throw;
        }
        catch (const error& e)
        {
            report.outcome = chart_outcome::no_map;
            report.reason = e.what();
        }
        ++done_;
    }

    /// Converts the maps to the units of the surface and certifies them.
    void certify()
    {
        parallel_for(
            work_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t k = begin; k < end; ++k)
                    if (!work_[k].uv.empty())
                        certify(k);
                    else if (result_.charts[k].outcome == chart_outcome::stopped)
                        result_.charts[k].reason = "the run ended before the chart had a map";
            },
            0, 1);
        result_.seconds.certify = clock_.lap();
    }

    void certify(std::size_t k)
    {
        chart_report& report = result_.charts[k];
        const auto& [surface, unit] = *work_[k].chart;
        auto& ideal = work_[k].ideal;
        if (!ideal) ideal.emplace(surface);
        start_map map;
        map.uv = std::move(work_[k].uv);
        assess(map, surface, *ideal);
        report.valid = bool(map.flips);
        if (!report.valid)
        {
            report.outcome = chart_outcome::no_map;
            report.reason = std::to_string(map.flips.defects()) + " triangles or vertices of the map are folded";
            return;
        }
        report.energy = map.distortion.measure;
        for (std::size_t i = 0; i < map.uv.size(); ++i)
            result_.uv[u(charts_.first_vertex[k]) + i] = map.uv[i] / unit; // a power of two: exact
    }

    std::size_t cells(std::size_t k) const { return u(charts_.first_cell[k + 1] - charts_.first_cell[k]); }

    queue& queue_;
    const chart_mesh& charts_;
    const flatten_params& params_;
    budget clock_;
    std::vector<chart_work> work_;
    flattened_charts result_;
    int done_ = 0;
};

} // namespace taut::impl

namespace taut
{

flattened_charts flatten_charts(queue& q, const chart_mesh& charts, const flatten_params& params,
                                const run_limits& limits)
{
    params.validate();
    limits.validate();
    if (!params.initial.empty() && params.initial.size() != charts.surface.points().size())
        throw parameter_error("initial", "must have one point a vertex of the chart mesh, or none");
    const queue_counters before = q.counters();
    flattened_charts result = impl::flattening(q, charts, params, limits).run();
    result.counters = impl::counted_since(before, q.counters());
    return result;
}

} // namespace taut
