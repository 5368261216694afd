// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/exact/certify.hpp>

namespace taut
{

template certificate certify<2>(std::span<const std::array<idx, 3>>, std::span<const vec<2>>, std::span<const double>,
                                std::size_t, std::span<const idx>);
template certificate certify<3>(std::span<const std::array<idx, 4>>, std::span<const vec<3>>, std::span<const double>,
                                std::size_t, std::span<const idx>);

} // namespace taut
