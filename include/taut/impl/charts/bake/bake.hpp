// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <span>

#include <taut/bake.hpp>
#include <taut/impl/charts/bake/texture_rows.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// What is baked: an old texture with places in it, with or without frames, or numbers at corners.
struct bake_source
{
    const texture_rows* old = nullptr;
    std::span<const std::array<vec2, 3>> from = {};
    const bake_frames* frames = nullptr;
    std::span<const float> values = {};
    idx channels = 0;
    std::span<const idx> numbers = {}; ///< of the triangles in messages, if they are others
};

/// Takes rows of a new texture: the first, how many, their texels, and a mark for each texel as in baked_texture.
using take_texels =
    std::function<void(idx first, idx rows, std::span<const float> texels, std::span<const idx> covered)>;

/// The new texture of bake() a few rows at a time, without gutters.
void bake_by_rows(queue& q, const bake_source& source, std::span<const std::array<vec2, 3>> to,
                  const bake_params& params, const take_texels& take);

/// The new texture of bake() of any source.
baked_texture bake_any(queue& q, const bake_source& source, std::span<const std::array<vec2, 3>> to,
                       const bake_params& params);

} // namespace taut::impl
