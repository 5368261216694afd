// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <limits>
#include <vector>

#include <taut/energy/isometric.hpp>
#include <taut/map/any_energy.hpp>
#include <taut/map/barycentric_map.hpp>
#include <taut/solve/minimize.hpp>

namespace taut
{

/// What becomes of the boundary during the optimisation.
enum class boundary_mode
{
    free, ///< it moves like everything else
    fixed ///< it stays where the start map has it
};

/// Arithmetic of the optimisation. Certificates are exact in any case.
enum class precision
{
    full,  ///< positions, elements and vectors in double
    mixed, ///< positions in double, differences cast to float, elements and vectors in float, sums in double
    single ///< everything in float, sums in double where the device has it: reaches relative gradients near 1e-5
};

/// How to parameterize. Every field has a sensible default.
struct parameterize_params
{
    /// What to minimise. A user's struct converts; so do sums and products of energies.
    any_energy energy = energy::isometric{};

    /// Whether elements count by rest area, as is usual, or all the same, as in the paper.
    energy::weighting weights = energy::weighting::measure;

    boundary_mode boundary = boundary_mode::free;

    /// Start: these coordinates, one a vertex, if there are any (with a free boundary their place and scale do not
    /// matter); else a barycentric map on a convex polygon with its
    /// stretch evened out, which costs little and saves most of the iterations. A start that is mirrored as a whole is
    /// turned over.
    std::vector<vec2> initial = {};
    barycentric_params start = {.stretch_rounds = 10};

    /// Whether a surface with holes (more than one boundary loop) is taken. Its map is locally injective.
    bool holes = false;

    taut::precision precision = precision::full;

    /// Method, line search, stopping. `solve.stopping.time_limit` is overruled by time_limit below.
    solve::params solve = {};

    /// Wall-clock limit of the whole call. When it is reached, the best map so far is returned.
    std::chrono::duration<double> time_limit = std::chrono::duration<double>(std::numeric_limits<double>::infinity());

    /// Asked at every iterate and trial step, and between the rounds of the start map, whether to go on.
    solve::observer observer = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!(time_limit.count() >= 0)) throw parameter_error("time_limit", "must not be negative");
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (boundary != boundary_mode::free && boundary != boundary_mode::fixed)
            throw parameter_error("boundary", "must be free or fixed");
        if (precision != precision::full && precision != precision::mixed && precision != precision::single)
            throw parameter_error("precision", "must be full, mixed or single");
        solve.validate();
    }
};

} // namespace taut
