// SPDX-License-Identifier: MIT
#pragma once

#include <locale>

#include <taut/certify.hpp>
#include <taut/quality.hpp>
#include <taut/start_map.hpp>

namespace taut::impl
{

/// Fills `flips` and `distortion`; `ideal` in the units of uv.
inline void assess(start_map& map, const mesh<triangle>& m, const ideal_elements<triangle>& ideal)
{
    map.flips = certify<2>(m.cells(), map.uv, ideal.measure);
    map.distortion =
        mean_over<triangle>(m, ideal, map.uv, [](const auto& e) { return bounded(energy::isometric{}, e); });
}

} // namespace taut::impl
