// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/atlas/detail/chart_batch.hpp>
#include <taut/atlas/flatten_charts.hpp>
#include <taut/core/budget.hpp>
#include <taut/map/parameterize.hpp>

namespace taut
{

TAUT_INLINE void flatten_params::validate() const
{
    if (!(tolerance >= 1e-12 && tolerance <= 1)) throw parameter_error("tolerance", "must be 1e-12 to 1");
    if (max_iterations < 0) throw parameter_error("max_iterations", "must not be negative");
    if (!(largest >= 0)) throw parameter_error("largest", "must not be negative");
    if (!(time_limit.count() >= 0)) throw parameter_error("time_limit", "must not be negative");
}

namespace detail
{

/// One call of flatten_charts.
class flattening
{
public:
    flattening(queue& q, const chart_mesh& charts, const flatten_params& params)
        : queue_(q), charts_(charts), params_(params), clock_(params.time_limit, params.observer),
          single_(u(charts.charts())), maps_(u(charts.charts()))
    {
        result_.charts.resize(u(charts.charts()));
        result_.uv.assign(charts.surface.points().size(), vec2(0.0));
    }

    flattened_charts run()
    {
        make_starts();
        minimize();
        map_large();
        certify();
        return std::move(result_);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Calls work(k) for each of some charts, in parallel, large pieces of them between questions to the clock.
    template <class Work>
    void for_charts(std::span<const idx> some, const Work& work)
    {
        constexpr std::size_t piece = 512;
        for (std::size_t first = 0; first < some.size() && proceed(); first += piece)
        {
            const auto part = some.subspan(first, std::min(piece, some.size() - first));
            parallel_for(
                part.size(),
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t i = begin; i < end; ++i) work(u(part[i]));
                },
                0, 1);
        }
    }

    bool proceed()
    {
        return clock_.proceed({.iteration = done_, .value = area_ > 0 ? energy_ / area_ : 0.0, .iterate = false});
    }

    void make_starts()
    {
        std::vector<idx> all(single_.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<idx>(k);
        for_charts(all,
                   [&](std::size_t k)
                   {
                       chart_report& report = result_.charts[k];
                       single_[k] = single_chart::of(charts_, static_cast<idx>(k));
                       auto start = chart_start::of(single_[k]->surface, given(k));
                       report.start_energy = start.energy;
                       report.reason = std::move(start.reason);
                       if (!report.reason.empty()) report.outcome = chart_outcome::no_map;
                       maps_[k] = std::move(start.uv);
                   });
        result_.seconds.start = clock_.lap();
    }

    /// What the user gave of a chart, in its units.
    std::vector<vec2> given(std::size_t k) const
    {
        if (params_.initial.empty()) return {};
        const auto part = params_.initial.subspan(u(charts_.first_vertex[k]),
                                                  u(charts_.first_vertex[k + 1] - charts_.first_vertex[k]));
        std::vector<vec2> uv(part.begin(), part.end());
        for (vec2& p : uv) p *= single_[k]->unit;
        return uv;
    }

    /// Newton's method, in batches whose arrays fit the memory of a device well.
    void minimize()
    {
        std::vector<idx> by_size;
        for (std::size_t k = 0; k < maps_.size(); ++k)
            if (!maps_[k].empty() && params_.max_iterations > 0) by_size.push_back(static_cast<idx>(k));
        if (by_size.empty() || clock_.over()) return;
        std::stable_sort(by_size.begin(), by_size.end(), [&](idx a, idx b) { return cells(a) > cells(b); });

        const chart_kernel program(queue_);
        result_.seconds.device += clock_.lap();
        const std::size_t most = program.team == 1 ? std::size_t{1} << 16 : std::size_t{1} << 20;
        for (std::size_t first = 0, last = 0; first < by_size.size() && !clock_.over(); first = last)
        {
            std::size_t count = 0;
            while (last < by_size.size() && (last == first || count + cells(by_size[last]) <= most))
                count += cells(by_size[last++]);
            minimize(program, std::span(by_size).subspan(first, last - first));
        }
    }

    void minimize(const chart_kernel& program, std::span<const idx> some)
    {
        std::vector<std::optional<chart_problem>> made(single_.size());
        for_charts(some, [&](std::size_t k) { made[k] = chart_problem::of(single_[k]->surface, maps_[k]); });
        if (clock_.over()) return;
        std::vector<chart_problem> problems;
        std::vector<std::size_t> chart;
        for (const idx k : some)
            if (made[u(k)]->profile.work <= 1e6 * params_.largest)
            {
                problems.push_back(std::move(*made[u(k)]));
                chart.push_back(u(k));
            }
            else
                result_.charts[u(k)].multigrid = true;
        if (problems.empty()) return;
        chart_batch batch(queue_, program, problems);
        result_.seconds.prepare += clock_.lap();

        std::vector<char> at_work(chart.size(), 1);
        for (int i = 0; i < params_.max_iterations; ++i)
        {
            const std::size_t left = batch.step(params_.tolerance);
            for (std::size_t j = 0; j < chart.size(); ++j)
            {
                if (!at_work[j]) continue;
                chart_report& report = result_.charts[chart[j]];
                report.iterations = i + 1;
                report.outcome = i + 1 < params_.max_iterations ? chart_outcome::stopped : chart_outcome::iterations;
                if (batch.state_of(j) == chart_batch::going) continue;
                at_work[j] = 0;
                report.outcome =
                    batch.state_of(j) == chart_batch::converged ? chart_outcome::converged : chart_outcome::stuck;
                ++done_;
            }
            if (left == 0 || !proceed()) break;
        }
        auto maps = batch.maps();
        for (std::size_t j = 0; j < chart.size(); ++j) maps_[chart[j]] = std::move(maps[j]);
        result_.seconds.solve += clock_.lap();
    }

    /// The charts that are left, one by one.
    void map_large()
    {
        for (std::size_t k = 0; k < maps_.size(); ++k)
        {
            chart_report& report = result_.charts[k];
            if (!report.multigrid || !proceed()) continue;
            auto params = parameterize_params{.initial = maps_[k], .holes = true, .time_limit = clock_.left()};
            params.observer = [this](const progress&) { return proceed(); };
            params.solve.stopping.max_iterations = params_.max_iterations;
            auto map = parameterize(queue_, single_[k]->surface, params);
            report.iterations = static_cast<int>(map.report.solve.iterations);
            report.outcome = solve::converged(map.report.solve.stop) ? chart_outcome::converged
                             : clock_.over()                           ? chart_outcome::stopped
                                                                       : chart_outcome::stuck;
            if (map) maps_[k] = std::move(map.uv);
            ++done_;
        }
        result_.seconds.large = clock_.lap();
    }

    /// Brings the maps to the units of the surface and looks at what came out.
    void certify()
    {
        parallel_for(
            maps_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t k = begin; k < end; ++k)
                    if (!maps_[k].empty()) certify(k);
            },
            0, 1);
        result_.seconds.certify = clock_.lap();
    }

    void certify(std::size_t k)
    {
        chart_report& report = result_.charts[k];
        const auto& [surface, unit] = *single_[k];
        start_map map;
        map.uv = maps_[k];
        map.assess(surface, ideal_elements<triangle>(surface));
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

    std::size_t cells(idx k) const { return u(charts_.first_cell[u(k) + 1] - charts_.first_cell[u(k)]); }

    queue& queue_;
    const chart_mesh& charts_;
    const flatten_params& params_;
    budget clock_;
    std::vector<std::optional<single_chart>> single_;
    std::vector<std::vector<vec2>> maps_; // of charts that have one, in their units
    flattened_charts result_;
    int done_ = 0;
    double energy_ = 0, area_ = 0;
};

} // namespace detail

TAUT_INLINE flattened_charts flatten_charts(queue& q, const chart_mesh& charts, const flatten_params& params)
{
    params.validate();
    if (!params.initial.empty() && params.initial.size() != charts.surface.points().size())
        throw parameter_error("initial", "must have one point a vertex of the chart mesh, or none");
    const queue_counters before = q.counters();
    flattened_charts result = detail::flattening(q, charts, params).run();
    result.counters = counted_since(before, q.counters());
    return result;
}

} // namespace taut
