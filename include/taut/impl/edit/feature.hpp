// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/impl/edit/region.hpp>

namespace taut
{

/// Feature cut from one surface to be pasted on another: a region with its base. The base is the plane fitted to the
/// rim; the displacement of the region from it is the detail.
struct feature
{
    /// Takes a region. Throws region_error for one whose rim encloses no area: its base has no normal.
    explicit feature(impl::surface_region of);

    impl::surface_region
        region;           ///< edges between vertices of the rim are halved: their middles are vertices -1 of the source
    vec3 centre{0.0};     ///< mean of the rim by length
    vec3 normal{0, 0, 1}; ///< unit normal of the base, to the outside
    double radius = 0;    ///< largest distance of the rim from the centre

    /// The axes of the base and its normal, as columns; right-handed.
    mat3 frame() const
    {
        const vec3 across = std::abs(normal.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        const vec3 first = glm::normalize(glm::cross(across, normal));
        return {first, glm::cross(normal, first), normal};
    }
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/edit/feature.ipp>
#endif
