// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <taut/impl/atlas/atlas_params.hpp>
#include <taut/impl/atlas/atlas_report.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/mesh/validate.hpp>
#include <taut/impl/packing/pack.hpp>

namespace taut
{

/// Texture atlas of a surface: charts packed side by side into unit squares.
struct atlas
{
    chart_mesh charts; ///< the surface cut apart
    /// One per vertex of charts.surface; tile t is the unit square at atlas_params::origin + (t % 10, t / 10), as in
    /// UDIM.
    std::vector<vec2> uv;
    packing layout; ///< rotation, scale and translation of the charts
    atlas_report report;

    /// Texture coordinates by corner: numbers into uv, a triple for each triangle of the surface, in its order.
    std::vector<std::array<idx, 3>> corners() const
    {
        std::vector<std::array<idx, 3>> result(charts.surface.cells().size());
        for (std::size_t i = 0; i < result.size(); ++i)
            result[static_cast<std::size_t>(charts.cell_origins[i])] = charts.surface.cells()[i];
        return result;
    }

    /// True if it is certified: no triangle is flipped, no two overlap, and charts are as far apart as asked.
    explicit operator bool() const { return report.reason.empty(); }
};

} // namespace taut

namespace taut::impl
{

/// Requirements of make_atlas() on a surface.
inline constexpr mesh_requirements atlas_requirements{
    .referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false};

} // namespace taut::impl

namespace taut
{

/// Makes an atlas of any surface: cuts it into charts that can be flattened within a bound of distortion, flattens all
/// of them at once on the queue's device, packs them, and certifies the result in exact arithmetic.
///
/// m: an oriented manifold without flat triangles; it may have several parts, be closed, have handles and holes.
///    repair_surface() (repair/repair_surface.hpp) makes one of other input.
/// limits: a run that they end returns the current charts, packed and certified all the same, and planar projections of
///    parts without a valid map; atlas_report::complete is false. The observer is asked several times a second:
///    progress::stage names the stage, progress::iteration counts the charts that are done in it, progress::value is
///    the mean energy of these, or the use of the squares.
/// Throws mesh_error, symmetry_error, parameter_error, device_error, build_error.
atlas make_atlas(queue& q, const mesh<triangle>& m, const atlas_params& params = {}, const run_limits& limits = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/atlas/make_atlas.ipp>
#endif
