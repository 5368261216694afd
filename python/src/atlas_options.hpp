// SPDX-License-Identifier: MIT
#pragma once

#include <taut/atlas.hpp>

#include "options.hpp"

namespace taut::python
{

/// A coordinate as single precision holds it.
inline vec2 in_float(vec2 x)
{
    return {static_cast<double>(static_cast<float>(x.x)), static_cast<double>(static_cast<float>(x.y))};
}

/// What atlas() takes that is no array: the one place where its names meet those of the library.
inline void read_atlas_options(atlas_params& params, const options& given)
{
    segment_params& charts = params.charts;
    given.read_word(
        "prefer", params.prefer,
        {{"seams", chart_preference::seams}, {"packing", chart_preference::packing}, {"one", chart_preference::one}});
    if (params.prefer == chart_preference::packing)
    {
        charts.max_distortion = segment_params{}.max_distortion;
        charts.mean_distortion = segment_params{}.mean_distortion;
    }
    given.read("max_distortion", charts.max_distortion);
    given.read("mean_distortion", charts.mean_distortion);
    given.read("least_fill", charts.tuning.least_fill);
    given.read("cut_rounds", charts.tuning.cut_rounds);
    given.read("unite_rounds", charts.tuning.unite_rounds);
    pack_params& packing = params.packing;
    given.read("resolution", packing.resolution);
    given.read("padding", packing.padding);
    given.read("tiles", packing.tiles);
    given.read("rotate", packing.rotate);
    given.read("symmetric", params.symmetric);
    given.read("aspect", packing.aspect);
    given.read("texels_per_unit", packing.texels_per_unit);
    given.read("max_resolution", packing.max_resolution);
    given.read("align", packing.align);
    given.read("stack", params.stack);
    given.read("hide_seams", params.hide_seams);
    given.read("crease_angle", params.crease_angle);
    given.read_word("charts", params.prefer,
                    {{"auto", params.prefer}, {"keep", chart_preference::kept}, {"pack", chart_preference::laid}});
    if (given.get("single", false)) params.stored = in_float;
}

} // namespace taut::python
