// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/chart_set.hpp>
#include <taut/impl/charts/atlas/cutting/way_prices.hpp>
#include <taut/impl/charts/atlas/seams/openness.hpp>
#include <taut/impl/charts/atlas/seams/seam_factors.hpp>
#include <taut/impl/core/core/budget.hpp>

namespace taut::impl
{

/// A surface, and what is asked of its atlas.
struct atlas_surface
{
    const mesh<triangle>& surface;
    const atlas_params& params;
    std::span<const idx> origins = {}; ///< of a part of another surface: its triangles there
    facet_table facets = impl::facets(surface);
    std::vector<double> factors = {}; ///< what seams count, one per side; or empty
    std::vector<double> open = {};    ///< what is seen of the surface, one per vertex; or empty
    std::optional<mirror_symmetry> mirror = {};

    /// The first triangle of a chart, as the user numbers it.
    idx first_triangle(const chart_mesh& charts, std::size_t chart) const
    {
        const idx c = charts.first_triangle(chart);
        return origins.empty() ? c : origins[static_cast<std::size_t>(c)];
    }

    /// What a seam along each side counts.
    std::vector<double> prices() const { return side_prices(surface, facets, params.charts.together, factors); }

    /// Returns whether a side is a seam in any case.
    bool is_given(std::size_t side) const { return !params.charts.seams.empty() && params.charts.seams[side] != 0; }

    /// Computes `factors` and `open`.
    void weigh_seams()
    {
        const seam_wishes wishes{params.hide_seams, params.crease_angle, params.charts.weights};
        wishes.validate(facets.twin.size());
        if (!wishes.any() || params.keeps_charts()) return;
        if (wishes.hide > 0) open = vertex_openness(surface);
        factors = seam_factors(surface, facets, wishes, open);
    }
};

/// What the phases of one make_atlas() share beside the charts: the device, the clock, the limits and the report.
struct atlas_run
{
    /// How charts are flattened.
    enum class precise
    {
        usual,
        exactly, ///< nearly to the limit of rounding, so that what can be flat is
        rough    ///< see flatten_tuning::rough
    };

    queue& device;
    const run_limits& asked;
    budget clock{asked.time_limit};
    atlas_report report = {};
    bool usable = false; ///< a run that ends now has a result

    /// Notes whether the time is over. Returns whether the run goes on.
    bool goes_on() { return report.complete = report.complete && clock.in_time(); }

    /// What is left of the limits, in a stage. Refers to this run.
    run_limits limits(std::string_view stage)
    {
        const auto ask = [this, stage](const progress& p)
        {
            const bool in_time = clock.in_time();
            const bool wanted = !asked.observer || asked.observer({.iteration = p.iteration,
                                                                   .value = p.value,
                                                                   .gradient = std::numeric_limits<double>::quiet_NaN(),
                                                                   .seconds = clock.total(),
                                                                   .stage = stage,
                                                                   .usable = usable});
            return report.complete = report.complete && in_time && wanted;
        };
        return {std::max(clock.left(), budget::seconds(1e-6)), ask};
    }

    /// Maps all charts, in `steps` each at most.
    flattened_charts flatten(const chart_mesh& charts, std::span<const vec2> initial = {}, precise how = precise::usual,
                             int steps = std::numeric_limits<int>::max())
    {
        flatten_params params;
        if (how == precise::exactly) params.tolerance = std::min(params.tolerance, 1e-9);
        params.tuning.rough = how == precise::rough;
        params.max_iterations = std::min(params.max_iterations, steps);
        params.initial = initial;
        const double begin = clock.total();
        auto flat = flatten_charts(device, charts, params, limits("flatten"));
        report.seconds.flatten += clock.total() - begin;
        usable = true;
        return flat;
    }
};

/// Cuts a surface along its seams.
inline chart_set cut(const atlas_surface& of, laid_surface laid)
{
    return cut(of.surface, of.facets, std::move(laid));
}

/// Maps all charts of a set, from its maps if it has any.
inline void flatten(atlas_run& run, chart_set& set, atlas_run::precise how = atlas_run::precise::usual)
{
    auto flat = run.flatten(set.charts, set.uv, how);
    set.uv = std::move(flat.uv);
    set.energy.clear();
    for (const auto& chart : flat.charts) set.energy.push_back(chart.energy);
}

/// Cuts a surface along seams, and maps its charts.
inline chart_set flattened(atlas_run& run, const atlas_surface& of, std::vector<char> seam,
                           atlas_run::precise how = atlas_run::precise::usual)
{
    chart_mesh charts = cut_charts(of.surface, of.facets, seam);
    chart_set set{std::move(seam), std::move(charts), {}, {}};
    flatten(run, set, how);
    return set;
}

} // namespace taut::impl
