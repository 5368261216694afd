// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/bake/bake_params.hpp>
#include <taut/impl/bake/tangent_frames.hpp>
#include <taut/impl/compute/queue.hpp>

namespace taut
{

/// Texture for a new atlas.
struct baked_texture
{
    texture image;
    std::vector<std::uint8_t> covered; ///< a number per texel: 1 its centre, or a sample of it, is in a triangle;
                                       ///< 2 it is within a texel and a half of one; 0 elsewhere (gutter)
};

/// Makes the texture for a new atlas of a surface that shows on it what the old texture shows through the old atlas:
/// each texel gets the old texture at the place on the surface that the new atlas has at its centre, on the device.
/// Texels outside of charts have the value of the nearest place of a chart within a texel and a half, and beyond that
/// the nearest such texel. Where triangles overlap in the new atlas, the first one counts.
///
/// from, to: old and new texture coordinates, one per corner of the same triangles, v upwards; a triangle with one that
///           is not finite is left out; one may not reach over 2^24 texels of the old texture
/// Throws parameter_error for numbers that do not fit together, device_error.
baked_texture bake(queue& q, const texture& old, std::span<const std::array<vec2, 3>> from,
                   std::span<const std::array<vec2, 3>> to, const bake_params& params = {});

/// The same for numbers at the corners of triangles, such as colours of vertices, linear in each triangle.
/// values: `channels` numbers (1 to 4) per corner, three corners per triangle
baked_texture bake(queue& q, std::span<const float> values, idx channels, std::span<const std::array<vec2, 3>> to,
                   const bake_params& params = {});

} // namespace taut

namespace taut::impl
{

/// Normals of the corners of a surface, and the tangents of both atlases.
struct bake_frames
{
    std::span<const std::array<vec3, 3>> normals; ///< unit vectors, one triple per triangle
    std::span<const corner_tangents> from, to;    ///< as tangent_frames() makes them
};

} // namespace taut::impl

namespace taut
{

/// The same for normals in tangent space: three channels (and alpha), (x + 1) / 2 of each coordinate along tangent,
/// bitangent and normal. They are turned from the tangents of the old atlas to those of the new one.
baked_texture bake(queue& q, const texture& old, const impl::bake_frames& frames,
                   std::span<const std::array<vec2, 3>> from, std::span<const std::array<vec2, 3>> to,
                   const bake_params& params = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/bake/bake.ipp>
#endif
