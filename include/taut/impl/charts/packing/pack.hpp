// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>

#include <taut/options.hpp>
#include <taut/pack.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

struct chart_outlines;

/// How long a layout is looked for, where the scale is unknown.
enum class packing_effort
{
    draft,    ///< to tell the good ones of many sets of charts
    estimate, ///< to compare two sets of charts, within some hundredths
    full
};

/// Packs charts with known borders in these coordinates. enough: use of the tiles beyond which no better layout is
/// looked for
packing pack_outlined(std::span<const vec2> uv, const chart_outlines& outlines, const pack_params& params,
                      const run_limits& limits, packing_effort effort = packing_effort::full,
                      double enough = std::numeric_limits<double>::infinity());

} // namespace taut::impl
