// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include <taut/impl/core/constrain/surface_constraints.hpp>
#include <taut/impl/core/map/run_clock.hpp>
#include <taut/impl/core/map/run_surface.hpp>
#include <taut/impl/core/objective/mapped_mesh.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// Prepared run of parameterize(): the input of all its phases.
struct map_run
{
    taut::queue queue;
    const parameterize_params& params; ///< validated
    const run_surface& in;
    run_clock& clock;
    surface_constraints held;
    std::optional<mesh_levels<triangle>>
        levels; ///< none where the method needs none, or the limits leave no time for them

    /// Refers to its arguments but the queue. Throws parameter_error for constraints of another mesh.
    map_run(taut::queue q, const run_surface& surface, const parameterize_params& p, run_clock& limits)
        : queue(std::move(q)),
          params(p),
          in(surface),
          clock(limits),
          held(p.constraints, in.surface.points().size(), in.fixed_boundary(p.boundary), in.unused, in.unit)
    {
        clock.spent(&map_seconds::setup);
        clock.stages.add({.stage = "setup", .vertices = vertices()});
        if (!clock.proceed() || !params.uses_levels() || on_host()) return;
        levels.emplace(make_levels());
        clock.proceed();
    }
    map_run(const map_run&) = delete;
    map_run& operator=(const map_run&) = delete;

    std::size_t vertices() const { return in.surface.points().size(); }

    /// factor: ratio of vertices between a level and the next coarser one.
    mesh_levels<triangle> make_levels(double factor = hierarchy_params{}.factor) const
    {
        mesh_levels<triangle> made(in.surface, held.marks().pinned(),
                                   {.factor = factor, .proceed = [this] { return clock.proceed(); }}, params.data);
        clock.spent(&map_seconds::hierarchy);
        clock.stages.add({.stage = "hierarchy", .vertices = vertices()});
        return made;
    }

    bool outline_pinned() const { return held.outline_pinned(in.surface, in.sides); }

    /// Returns whether the map is unconstrained.
    bool is_free() const { return params.boundary == boundary_mode::free && !held.constrained(); }

    /// Whether borders are kept apart on the host from the start on (map_tuning::apart).
    bool on_host() const
    {
        constexpr std::size_t most = 2000; // vertices: a device is as fast for more
        return params.tuning.apart && vertices() <= most;
    }

    /// Without iterations the start is returned as it is.
    bool iterates() const { return params.solve.max_iterations > 0; }

    /// The precision of the first attempt.
    taut::precision first_precision() const
    {
        if (params.precision != precision::automatic) return params.precision;
        if (!queue.device().has_fp64()) return precision::fp32;
        return levels ? precision::mixed : precision::fp64;
    }

    /// Returns whether a start that is not given is computed on coarser levels: without fixed coordinates, as part of
    /// an attempt.
    bool starts_coarse() const { return may_start_coarse() && !held.constrained(); }

    /// Returns whether pins are reached by a penalty continuation there.
    bool uses_continuation() const
    {
        return may_start_coarse() && held.pinned() && params.boundary == boundary_mode::free && params.energy.barrier();
    }

private:
    bool may_start_coarse() const
    {
        return levels && (params.start == start_method::coarse || params.start == start_method::automatic);
    }
};

} // namespace taut::impl
