// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/impl/edit/attach/laid_feature.hpp>
#include <taut/impl/edit/paste.hpp>
#include <taut/impl/edit/paste.ipp>
#include <taut/impl/map/parameterize.hpp>

namespace taut
{

map_result paste::parameterize_feature(queue& q, std::span<const impl::feature_pin> pins) const
{
    const auto& region = part().region;
    auto wanted = impl::rim_pins(region, rim_uv());
    for (const auto& pin : pins) wanted.pin(pin.vertex, pin.at);
    return taut::parameterize(q, region.surface, {.constraints = wanted});
}

} // namespace taut
