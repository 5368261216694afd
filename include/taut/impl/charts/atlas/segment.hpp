// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>

namespace taut::impl
{

/// Maps of charts, as returned by flatten_charts().
struct chart_maps
{
    std::vector<vec2> uv;       ///< one per vertex
    std::vector<double> energy; ///< one per chart; +infinity where there is no valid map
    std::vector<char> settled;  ///< one per chart; 0: the map could be better, for want of effort
};

/// Maps of charts; those with an initial map are minimised to convergence.
using charts_to_maps = std::function<chart_maps(const chart_mesh&, std::span<const vec2>)>;

/// Segmentation before the surface is cut apart.
struct uncut_segmentation
{
    laid_surface laid;
    std::vector<char> crosses; ///< one per triangle: whether its chart overlaps itself
    segment_report report;     ///< but for what it says of seams and counts of charts
};

uncut_segmentation segment_surface(const mesh<triangle>& m, const facet_table& f, const charts_to_maps& flatten,
                                   const segment_params& params, const run_limits& limits);

segmentation cut_apart(const mesh<triangle>& m, const facet_table& f, uncut_segmentation made,
                       const segment_params& params);

/// Type-erased `flatten` of segment().
template <class Flatten>
charts_to_maps maps_by(Flatten& flatten)
{
    return [&flatten](const chart_mesh& charts, std::span<const vec2> start)
    {
        constexpr bool in_steps = std::is_invocable_v<Flatten&, const chart_mesh&, std::span<const vec2>>;
        auto flat = [&]
        {
            if constexpr (in_steps)
                return flatten(charts, start);
            else
                return flatten(charts);
        }();
        chart_maps maps{std::move(flat.uv), {}, {}};
        for (const auto& chart : flat.charts)
        {
            maps.energy.push_back(chart.valid ? chart.energy : std::numeric_limits<double>::infinity());
            if constexpr (in_steps)
                maps.settled.push_back(!chart.valid || chart.settled());
            else
                maps.settled.push_back(1);
        }
        return maps;
    };
}

/// segment() of a surface whose facets are f.
template <class Flatten>
segmentation segment(const mesh<triangle>& m, const facet_table& f, Flatten&& flatten,
                     const segment_params& params = {}, const run_limits& limits = {})
{
    return cut_apart(m, f, segment_surface(m, f, maps_by(flatten), params, limits), params);
}

} // namespace taut::impl

namespace taut
{

template <class Flatten>
segmentation segment(const mesh<triangle>& m, Flatten&& flatten, const segment_params& params, const run_limits& limits)
{
    return impl::segment(m, impl::facets(m), flatten, params, limits);
}

} // namespace taut
