// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <taut/impl/bake/bake.hpp>
#include <taut/impl/bake/fill_gutters.hpp>
#include <taut/impl/bake/triangle_tiles.hpp>
#include <taut/impl/compute/buffer.hpp>
#include <taut/impl/compute/kernel.hpp>
#include <taut/impl/compute/kernels/bake.hpp>
#include <taut/impl/compute/program/few_functions.hpp>

namespace taut::impl
{

constexpr idx bake_tile = 16;      ///< texels along the side of a tile
constexpr double bake_reach = 1.5; ///< texels around charts that have the value of the nearest place of one

inline bool all_finite(const std::array<vec2, 3>& t)
{
    return std::all_of(t.begin(), t.end(), [](const vec2& x) { return std::isfinite(x.x) && std::isfinite(x.y); });
}

/// What is baked: an old texture with places in it, with or without frames, or numbers at corners.
struct bake_source
{
    const texture* old = nullptr;
    std::span<const std::array<vec2, 3>> from = {};
    const bake_frames* frames = nullptr;
    std::span<const float> values = {};
    idx channels = 0;
};

/// Places of corners in texels, six numbers a triangle; those of triangles that are left out are 0.
inline std::vector<float> places_in_texels(std::span<const std::array<vec2, 3>> places)
{
    std::vector<float> numbers;
    numbers.reserve(6 * places.size());
    for (const auto& t : places)
        for (const vec2& x : t)
            for (const double y : {x.x, x.y}) numbers.push_back(std::isfinite(y) ? static_cast<float>(y) : 0.0f);
    return numbers;
}

/// Throws parameter_error where floats cannot tell one texel from the next.
inline void require_told_apart(const std::array<vec2, 3>& in_texels, std::size_t triangle)
{
    constexpr double most = 0x1p24;
    for (const vec2& x : in_texels)
        if (!(std::max(std::abs(x.x), std::abs(x.y)) <= most))
            throw parameter_error("from", "triangle " + std::to_string(triangle) +
                                              " reaches over 2^24 texels of the old texture or more, which floats do "
                                              "not tell apart; correct its texture coordinates");
}

/// Places in the old texture, in its texels, near the unit square where it repeats: floats are finest there.
inline std::vector<float> old_places(const bake_source& s, texture::wrap wrap)
{
    std::vector<std::array<vec2, 3>> places(s.from.begin(), s.from.end());
    for (auto& t : places)
    {
        vec2 shift = glm::floor(glm::min(t[0], glm::min(t[1], t[2])));
        if (wrap == texture::wrap::clamp || !all_finite(t)) shift = vec2(0.0);
        for (vec2& x : t) x = (x - shift) * vec2(s.old->width, s.old->height);
        if (all_finite(t)) require_told_apart(t, static_cast<std::size_t>(&t - places.data()));
    }
    return places_in_texels(places);
}

inline std::vector<float> numbers_of_tangents(std::span<const corner_tangents> tangents)
{
    std::vector<float> numbers;
    for (const auto& t : tangents)
        for (const auto& x : t)
            for (int k = 0; k < 4; ++k) numbers.push_back(static_cast<float>(x[k]));
    return numbers;
}

inline std::vector<float> numbers_of_normals(std::span<const std::array<vec3, 3>> normals)
{
    std::vector<float> numbers;
    for (const auto& t : normals)
        for (const vec3& x : t)
            for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(x[k]));
    return numbers;
}

/// OpenCL has no buffers of nothing.
template <class T>
buffer<T> buffer_of(queue& q, std::vector<T> values)
{
    if (values.empty()) values.push_back(T(0));
    return buffer<T>(q, values);
}

/// Throws parameter_error where numbers of parts do not fit together.
inline void require_fitting(const bake_source& s, std::size_t triangles)
{
    const auto require = [&](const char* name, std::size_t n)
    {
        if (n != triangles)
            throw parameter_error(name, std::to_string(n) + " for " + std::to_string(triangles) +
                                            " triangles; give three corners for each triangle of `to`");
    };
    if (s.old)
    {
        s.old->validate("old");
        require("from", s.from.size());
    }
    else if (s.channels < 1 || s.channels > 4)
        throw parameter_error("channels", "must be from 1 to 4");
    else
        require("values", s.values.size() / static_cast<std::size_t>(3 * s.channels));
    if (!s.frames) return;
    if (s.old->channels < 3) throw parameter_error("old", "normals have three channels, or four");
    require("normals", s.frames->normals.size());
    require("from", s.frames->from.size());
    require("to", s.frames->to.size());
}

/// The new texture, empty.
inline baked_texture empty_texture(const bake_source& s, const bake_params& params)
{
    baked_texture result;
    texture& image = result.image;
    image.channels = s.old ? s.old->channels : s.channels;
    image.width = params.width > 0 ? params.width : s.old ? s.old->width : 1024;
    image.height = params.height > 0 ? params.height : s.old ? s.old->height : 1024;
    image.texels.resize(image.size());
    result.covered.resize(image.size() / static_cast<std::size_t>(image.channels));
    return result;
}

/// Places of corners in texels of the new texture; not finite where a triangle is left out.
inline std::vector<std::array<vec2, 3>> new_places(const bake_source& s, std::span<const std::array<vec2, 3>> to,
                                                   const bake_params& params, const texture& image)
{
    std::vector<std::array<vec2, 3>> places(to.begin(), to.end());
    for (std::size_t f = 0; f < places.size(); ++f)
        for (vec2& x : places[f])
            x = !s.old || all_finite(s.from[f]) ? (x - params.origin) * vec2(image.width, image.height)
                                                : vec2(std::numeric_limits<double>::quiet_NaN());
    return places;
}

/// What the kernel reads, on the device.
struct bake_buffers
{
    bake_buffers(queue& q, const bake_source& s, std::span<const std::array<vec2, 3>> places, const csr& tiles,
                 texture::wrap wrap)
        : starts(buffer_of(q, tiles.offsets)),
          items(buffer_of(q, tiles.items)),
          uv(buffer_of(q, places_in_texels(places))),
          old_uv(buffer_of(q, s.old ? old_places(s, wrap) : std::vector<float>())),
          old_texels(buffer_of(q, s.old ? s.old->texels : std::vector<float>())),
          values(buffer_of(q, std::vector<float>(s.values.begin(), s.values.end()))),
          normals(buffer_of(q, s.frames ? numbers_of_normals(s.frames->normals) : std::vector<float>())),
          old_tangents(buffer_of(q, s.frames ? numbers_of_tangents(s.frames->from) : std::vector<float>())),
          new_tangents(buffer_of(q, s.frames ? numbers_of_tangents(s.frames->to) : std::vector<float>()))
    {
    }

    buffer<idx> starts, items;
    buffer<float> uv, old_uv, old_texels, values, normals, old_tangents, new_tangents;
};

inline baked_texture bake_any(queue& q, const bake_source& s, std::span<const std::array<vec2, 3>> to,
                              const bake_params& params)
{
    params.validate();
    require_fitting(s, to.size());
    baked_texture result = empty_texture(s, params);
    texture& image = result.image;
    const idx across = (image.width + bake_tile - 1) / bake_tile, down = (image.height + bake_tile - 1) / bake_tile;
    const auto places = new_places(s, to, params, image);
    const bake_buffers on(q, s, places, triangles_by_tile(places, bake_tile, across, down, bake_reach + 0.01),
                          params.wrap);
    const kernel run(q, kernels::bake, "bake_texels", few_functions + ("-DCHANNELS=" + std::to_string(image.channels)));

    // Some rows at a time, so that the new texture need not be on the device as a whole.
    const auto width = static_cast<std::size_t>(image.width), channels = static_cast<std::size_t>(image.channels);
    const std::size_t most = std::max<std::size_t>(1, (std::size_t(1) << 25) / (width * channels));
    const idx band = static_cast<idx>(std::min(most, static_cast<std::size_t>(image.height)));
    buffer<float> texels(q, width * static_cast<std::size_t>(band) * channels);
    buffer<idx> covered(q, width * static_cast<std::size_t>(band));
    std::vector<idx> marks(covered.size());
    for (idx first = 0; first < image.height; first += band)
    {
        const idx rows = std::min(band, image.height - first);
        const std::size_t count = width * static_cast<std::size_t>(rows), at = width * static_cast<std::size_t>(first);
        run({padded(count, 64), 64}, {{"width", image.width},
                                      {"first_row", first},
                                      {"rows", rows},
                                      {"tile", bake_tile},
                                      {"tiles_across", across},
                                      {"samples", params.samples},
                                      {"reach", bake_reach},
                                      {"starts", on.starts},
                                      {"items", on.items},
                                      {"uv", on.uv},
                                      {"source", idx(!s.old     ? 1
                                                     : s.frames ? 2
                                                                : 0)},
                                      {"old_uv", on.old_uv},
                                      {"old_texels", on.old_texels},
                                      {"old_width", s.old ? s.old->width : 1},
                                      {"old_height", s.old ? s.old->height : 1},
                                      {"nearest", idx(params.filter == texture::filter::nearest)},
                                      {"repeat", idx(params.wrap == texture::wrap::repeat)},
                                      {"values", on.values},
                                      {"normals", on.normals},
                                      {"old_tangents", on.old_tangents},
                                      {"new_tangents", on.new_tangents},
                                      {"green", params.green_down ? -1.0 : 1.0},
                                      {"texels", texels},
                                      {"covered", covered}});
        texels.download(std::span(image.texels).subspan(at * channels, count * channels));
        covered.download(std::span(marks).first(count));
        std::transform(marks.begin(), marks.begin() + static_cast<std::ptrdiff_t>(count),
                       result.covered.begin() + static_cast<std::ptrdiff_t>(at),
                       [](idx mark) { return static_cast<std::uint8_t>(mark); });
    }
    fill_gutters(image, result.covered, params.gutter);
    return result;
}

} // namespace taut::impl

namespace taut
{

baked_texture bake(queue& q, const texture& old, std::span<const std::array<vec2, 3>> from,
                   std::span<const std::array<vec2, 3>> to, const bake_params& params)
{
    return impl::bake_any(q, {.old = &old, .from = from}, to, params);
}

baked_texture bake(queue& q, std::span<const float> values, idx channels, std::span<const std::array<vec2, 3>> to,
                   const bake_params& params)
{
    return impl::bake_any(q, {.values = values, .channels = channels}, to, params);
}

baked_texture bake(queue& q, const texture& old, const impl::bake_frames& frames,
                   std::span<const std::array<vec2, 3>> from, std::span<const std::array<vec2, 3>> to,
                   const bake_params& params)
{
    return impl::bake_any(q, {.old = &old, .from = from, .frames = &frames}, to, params);
}

} // namespace taut
