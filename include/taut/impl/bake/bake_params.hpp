// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include <taut/impl/bake/texture.hpp>

namespace taut
{

/// Parameters of bake() and its like.
struct bake_params
{
    idx width = 0, height = 0; ///< texels of the new texture; 0: as many as the old one has, 1024 where there is none
    texture::filter filter = texture::filter::bilinear; ///< of the old texture
    texture::wrap wrap = texture::wrap::repeat;         ///< of the old texture
    idx samples = 1; ///< along each side of a texel, 1 to 8: their mean is taken, for a new texture that is coarser
                     ///< than the old one; not with `nearest`
    double gutter = std::numeric_limits<double>::infinity(); ///< texels around charts that get the nearest texel of a
                                                             ///< chart; what is farther stays 0
    vec2 origin =
        vec2(0.0); ///< lower left corner of the unit square that the new texture covers: (1, 0) is 1002 of UDIM
    bool green_down = false; ///< of bake() of normals: green grows downwards in the image, as for DirectX

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (width < 0 || width > 65536) throw parameter_error("width", "must be from 1 to 65536, or 0");
        if (height < 0 || height > 65536) throw parameter_error("height", "must be from 1 to 65536, or 0");
        if (samples < 1 || samples > 8) throw parameter_error("samples", "must be from 1 to 8");
        if (samples > 1 && filter == texture::filter::nearest)
            throw parameter_error("samples", "a mean of labels is none; give 1 with the filter `nearest`");
        if (!(gutter >= 0)) throw parameter_error("gutter", "must be 0 or more");
        if (!std::isfinite(origin.x) || !std::isfinite(origin.y)) throw parameter_error("origin", "must be finite");
    }
};

} // namespace taut
