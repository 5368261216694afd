// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/core/budget.hpp>
#include <taut/impl/core/error.hpp>

namespace taut::impl
{

/// Tuning of segmentation.
struct segment_tuning
{
    /// Minimum fill of the convex hull in the plane, 0 to 1: charts of more than a 200th of the area below it are cut,
    /// as branching charts pack badly.
    double least_fill = 0.82;

    /// Maximum number of rounds of cuts, 0 to 100. In each, the new charts are flattened.
    int cut_rounds = 8;

    /// Maximum number of rounds of unions of neighbours, 0 to 100. In each, most of the surface is flattened again.
    /// Small charts are tried once more, unless it is 0.
    int unite_rounds = 1;

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(least_fill >= 0 && least_fill <= 1)) throw parameter_error("least_fill", "must be 0 to 1");
        if (cut_rounds < 0 || cut_rounds > 100) throw parameter_error("cut_rounds", "must be 0 to 100");
        if (unite_rounds < 0 || unite_rounds > 100) throw parameter_error("unite_rounds", "must be 0 to 100");
    }
};

} // namespace taut::impl

namespace taut
{

/// Parameters of segment(). Distortions are area means of energy::isometric, 4 at least.
struct segment_params
{
    /// Bound of a chart, above 4. Charts above it are cut further.
    double max_distortion = 4.2;

    /// Bound of the mean over the whole surface, above 4, at one common scale, under which charts are united.
    double mean_distortion = 4.045;

    /// Edges that are to be seams in any case: one flag per side, the same on both sides of an edge; or empty.
    std::span<const char> seams = {};

    /// Edges that are no seams, as the diagonals of a polygon: one flag per side as above; or empty. Seams use them
    /// only where a bound cannot be met otherwise.
    std::span<const char> together = {};

    /// What a unit of length of a seam counts along each side, the same on both sides of an edge; or empty: 1.
    std::span<const double> weights = {};

    /// Not for users: what tests and measurements set.
    impl::segment_tuning tuning = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(max_distortion > 4)) throw parameter_error("max_distortion", "must be above 4, that of no distortion");
        if (!(mean_distortion > 4)) throw parameter_error("mean_distortion", "must be above 4, that of no distortion");
        tuning.validate();
    }
};

} // namespace taut

namespace taut::impl
{

/// Report of a segmentation.
struct segment_report
{
    double distortion = 4;   ///< distortion of the whole surface, charts without a map left out
    idx unmapped = 0;        ///< charts without a valid map
    idx above = 0;           ///< charts above max_distortion: of single triangles, or for want of rounds or time
    idx crossing = 0;        ///< charts whose boundary meets itself in the plane
    idx cut = 0, united = 0; ///< charts cut further, pairs united
    double seam_length = 0;  ///< in units of the surface
};

} // namespace taut::impl

namespace taut
{

/// Segmentation of a surface into charts, with their maps.
struct segmentation
{
    std::vector<char> seam; ///< one flag per side of the surface; some have one chart on both sides
    chart_mesh charts;
    std::vector<vec2> uv;       ///< one per vertex of charts.surface: as it was flattened
    std::vector<double> energy; ///< one per chart; +infinity where there is no valid map
    impl::segment_report report;
};

} // namespace taut

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

} // namespace taut::impl

namespace taut
{

/// Cuts a surface into charts that can be flattened within a bound of distortion, few of them, along short seams that
/// follow creases. Every chart is a disk, or one with holes of the surface in it, whatever the surface is: closed, with
/// handles, of several components.
///
/// Pieces are united bottom-up by an estimate of their distortion; then charts are flattened, cut further where they
/// are above the bound, and united where that is possible (cluster_tree.hpp). Deterministic if `flatten` is. Time O(n
/// log n) beside that of `flatten`.
///
/// m: an oriented manifold without flat triangles; f: its facets
/// flatten: callable with a chart_mesh, returns uv (one per vertex), and charts with `valid` and `energy` each. It may
///    take a second argument, std::span<const vec2>, the initial map, and report settled() of charts: then it may
///    return unfinished maps, as many charts are cut anyway. Remaining charts that are not settled are passed again
///    with their maps.
/// limits: then the current charts are returned, or pieces without maps. The observer is asked before each round and
///    within it
/// Throws parameter_error; mesh_error (non_manifold_facet, inconsistent_orientation).
template <class Flatten>
segmentation segment(const mesh<triangle>& m, const impl::facet_table& f, Flatten&& flatten,
                     const segment_params& params = {}, const run_limits& limits = {})
{
    return impl::cut_apart(m, f, impl::segment_surface(m, f, impl::maps_by(flatten), params, limits), params);
}
template <class Flatten>
segmentation segment(const mesh<triangle>& m, Flatten&& flatten, const segment_params& params = {},
                     const run_limits& limits = {})
{
    return segment(m, impl::facets(m), flatten, params, limits);
}

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/atlas/segment.ipp>
#endif
