// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <taut/types.hpp>

namespace taut::impl
{

/// Hard pin: coordinates of a vertex that are fixed exactly: bit k of `held` says that coordinate k is value[k].
template <int D>
struct hard_pin
{
    std::uint8_t held = 0;
    vec<D> value{0.0};
};

} // namespace taut::impl

namespace taut
{

/// Spring (soft constraint): weight * |x - target|^2 is added to the objective.
template <int D>
struct spring
{
    idx vertex;
    vec<D> target;
    double weight;
};

} // namespace taut
