// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/impl/edit/paste.hpp>
#include <taut/impl/map/parameterize.hpp>

namespace taut::impl
{

/// Pin of a vertex of a feature in the map of the target.
struct feature_pin
{
    idx vertex; ///< of the feature's region
    vec2 at;
};

} // namespace taut::impl

namespace taut
{

/// Maps the feature of a paste into the map of the target (paper, section 4.1): its rim is pinned to the
/// correspondences of the paste, with any other vertices that are named, and the rest is mapped as isometrically as
/// that allows, without flips. The rim is a simple polygon, so without other pins there is a map; where these
/// contradict it, the outcome is infeasible, and report.ids names the triangles or vertices. Throws constraint_error,
/// device_error.
map_result parameterize_feature(queue& q, const paste& p, std::span<const impl::feature_pin> pins = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/edit/parameterize_feature.ipp>
#endif
