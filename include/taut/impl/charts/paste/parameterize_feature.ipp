// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/impl/charts/paste/attach/laid_feature.hpp>
#include <taut/impl/charts/paste/paste.ipp>
#include <taut/parameterize.hpp>
#include <taut/paste.hpp>

namespace taut
{

map_result paste::parameterize_feature(queue& q, std::span<const feature_pin> pins) const
{
    const auto& region = part().region;
    auto wanted = impl::rim_pins(region, rim_uv());
    for (const auto& pin : pins) wanted.pin(pin.vertex, pin.at);
    return taut::parameterize(q, region.surface, {.constraints = wanted});
}

} // namespace taut
