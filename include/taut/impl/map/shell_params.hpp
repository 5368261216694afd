// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/mesh/thin_shell.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/params.hpp>

namespace taut
{

/// Parameters of deform() and of sessions of thin shells. Every field has a sensible default.
struct shell_params
{
    /// Pins, which are met bit for bit, and springs, of the mesh thin_shell::hinges().
    taut::constraints<hinge> constraints = {};

    /// Thickness in the lengths of the surface; none: the mean edge. The cost of bending against stretching is that of
    /// a plate of this thickness: thin shells crease and wrinkle where thick ones arch. Range > 0.
    std::optional<double> thickness = {};

    /// Initial shape, if it is not that at rest: of the last step, say. One position per vertex.
    std::vector<vec3> initial = {};

    taut::precision precision = precision::automatic;

    /// As in deform_params.
    solve::params solve = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (thickness && (!(*thickness > 0) || !std::isfinite(*thickness)))
            throw parameter_error("thickness", "must be positive and finite");
    }
};

} // namespace taut
