// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include <taut/impl/charts/packing/certificate.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/pack.hpp>
#include <taut/types.hpp>

namespace taut
{

packing_certificate certify_packing(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                                    std::span<const idx> first_cell, std::span<const idx> first_vertex,
                                    std::span<const char> pinned, double aspect)
{
    impl::check_charts(uv, cells, first_cell, first_vertex);
    return impl::certify_outlined(uv, cells, impl::find_outlines(uv, cells, first_cell, first_vertex), pinned, aspect);
}

} // namespace taut
