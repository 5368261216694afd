// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/edit/attach/laid_feature.hpp>
#include <taut/impl/edit/parameterize_feature.hpp>
#include <taut/impl/edit/paste.ipp>

namespace taut
{

map_result parameterize_feature(queue& q, const paste& p, std::span<const impl::feature_pin> pins)
{
    const auto& region = p.part().region;
    auto wanted = impl::rim_pins(region, p.rim_uv());
    for (const auto& pin : pins) wanted.pin(pin.vertex, pin.at);
    return parameterize(q, region.surface, {.constraints = wanted});
}

} // namespace taut
