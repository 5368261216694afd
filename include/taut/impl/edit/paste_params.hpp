// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/edit/rbf_basis.hpp>

namespace taut
{

/// Pose of a feature on the target: by default, the smallest rotation takes the normal of its base to the normal of the
/// target, half of its rim above the surface and half below.
struct paste_pose
{
    double turn = 0;     ///< about the target's normal, in radians, counter-clockwise as seen from outside
    double scale = 1;    ///< lengths of the pasted feature by those of the source
    vec3 shift{0.0};     ///< in the units of the target
    double softness = 0; ///< 0: the feature keeps its shape, the target bends to meet it; 1: the rim lies on the
                         ///< target, the feature bends; between: between

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!std::isfinite(turn)) throw parameter_error("turn", "must be a number");
        if (!(scale > 0) || !std::isfinite(scale)) throw parameter_error("scale", "must be a positive number");
        if (!(softness >= 0 && softness <= 1)) throw parameter_error("softness", "must be from 0 to 1");
        if (!std::isfinite(shift.x) || !std::isfinite(shift.y) || !std::isfinite(shift.z))
            throw parameter_error("shift", "must be numbers");
    }
};

} // namespace taut

namespace taut::impl
{

/// Tuning of a paste.
struct paste_tuning
{
    /// Basis of the fields that bend target and feature. `linear` overshoots least.
    rbf_basis basis = rbf_basis::linear;

    /// Maximum number of control points of each kind: along the rim, and fixed ones.
    idx controls = 300;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (controls < 8) throw parameter_error("controls", "must be at least 8");
        rbf_value(basis, 0, 1);
    }
};

} // namespace taut::impl

namespace taut
{

/// Parameters of a paste. Every field has a sensible default.
struct paste_params
{
    paste_pose pose = {}; ///< initial pose of the feature

    /// Radius of the region of the target that may bend, relative to that of the scaled rim: 1.2 or more. Triangles
    /// under the rim are replaced.
    double reach = 1.8;

    /// Not for users: what tests and measurements set.
    impl::paste_tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        pose.validate();
        if (!(reach >= 1.2) || !std::isfinite(reach)) throw parameter_error("reach", "must be 1.2 or more");
        tuning.validate();
    }
};

} // namespace taut
