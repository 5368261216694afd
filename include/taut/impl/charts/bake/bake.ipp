// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <taut/bake.hpp>
#include <taut/impl/charts/bake/bake.hpp>
#include <taut/impl/charts/bake/fill_gutters.hpp>
#include <taut/impl/charts/bake/triangle_tiles.hpp>
#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/kernels/bake.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

constexpr idx bake_tile = 16;      ///< texels along the side of a tile
constexpr double bake_reach = 1.5; ///< texels around charts that have the value of the nearest place of one

inline bool all_finite(const std::array<vec2, 3>& t)
{
    return std::all_of(t.begin(), t.end(), [](const vec2& x) { return std::isfinite(x.x) && std::isfinite(x.y); });
}

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

/// Number of a continuation in the kernel: its period.
inline idx period_of(texture::wrap wrap)
{
    return wrap == texture::wrap::clamp ? 0 : wrap == texture::wrap::repeat ? 1 : 2;
}

/// Places in the old texture, in its texels, near the unit square where it repeats: floats are finest there.
inline std::vector<float> old_places(const bake_source& s, const bake_params& params)
{
    std::vector<std::array<vec2, 3>> places(s.from.begin(), s.from.end());
    const vec2 period(period_of(params.wrap), period_of(params.wrap_v.value_or(params.wrap)));
    for (auto& t : places)
    {
        const vec2 low = glm::min(t[0], glm::min(t[1], t[2]));
        vec2 shift(0.0);
        for (int k = 0; k < 2 && all_finite(t); ++k)
            if (period[k] > 0) shift[k] = period[k] * std::floor(low[k] / period[k]);
        for (vec2& x : t) x = (x - shift) * vec2(s.old->width, s.old->height);
        const auto k = static_cast<std::size_t>(&t - places.data());
        if (all_finite(t)) require_told_apart(t, s.numbers.empty() ? k : usize(s.numbers[k]));
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

/// The new texture, without texels.
inline texture shape_of_baked(const bake_source& s, const bake_params& params)
{
    texture image;
    image.channels = s.old ? s.old->channels : s.channels;
    image.width = params.width > 0 ? params.width : s.old ? s.old->width : 1024;
    image.height = params.height > 0 ? params.height : s.old ? s.old->height : 1024;
    return image;
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

/// The numbers of an old texture on the device, a few rows at a time; the kernel knows their type.
inline buffer<float> texels_on_device(queue& q, const texture_rows* old)
{
    if (!old) return buffer_of(q, std::vector<float>());
    const std::size_t row = old->bytes_of_row(), bytes = row * usize(old->height), word = sizeof(float);
    buffer<float> texels(q, (bytes + word - 1) / word);
    constexpr std::size_t at_once = std::size_t(1) << 22;
    std::vector<float> some;
    std::size_t kept = 0, sent = 0; // bytes of `some`, words
    const auto send = [&](std::size_t words)
    {
        texels.upload(std::span<const float>(some).first(words), sent);
        sent += words;
        const std::size_t rest = kept > words * word ? kept - words * word : 0;
        std::memmove(some.data(), reinterpret_cast<const std::byte*>(some.data()) + words * word, rest);
        kept = rest;
    };
    some.resize((at_once + row) / word + 2);
    for (idx j = 0; j < old->height; ++j)
    {
        old->read(j, reinterpret_cast<std::byte*>(some.data()) + kept);
        kept += row;
        if (kept >= at_once) send(kept / word);
    }
    if (kept > 0) send((kept + word - 1) / word);
    return texels;
}

/// What the kernel reads, on the device.
struct bake_buffers
{
    bake_buffers(queue& q, const bake_source& s, std::span<const std::array<vec2, 3>> places, const csr& tiles,
                 const bake_params& params)
        : starts(buffer_of(q, tiles.offsets)),
          items(buffer_of(q, tiles.items)),
          uv(buffer_of(q, places_in_texels(places))),
          old_uv(buffer_of(q, s.old ? old_places(s, params) : std::vector<float>())),
          old_texels(texels_on_device(q, s.old)),
          old_table(buffer_of(q, s.old ? s.old->table : std::vector<float>())),
          values(buffer_of(q, std::vector<float>(s.values.begin(), s.values.end()))),
          normals(buffer_of(q, s.frames ? numbers_of_normals(s.frames->normals) : std::vector<float>())),
          old_tangents(buffer_of(q, s.frames ? numbers_of_tangents(s.frames->from) : std::vector<float>())),
          new_tangents(buffer_of(q, s.frames ? numbers_of_tangents(s.frames->to) : std::vector<float>()))
    {
    }

    buffer<idx> starts, items;
    buffer<float> uv, old_uv, old_texels, old_table, values, normals, old_tangents, new_tangents;
};

/// Number of the kind of source in the kernel.
inline idx kind_of(const bake_source& s)
{
    if (!s.old) return 1;
    if (!s.frames) return 0;
    return s.frames->directions ? 3 : 2;
}

inline own_program bake_program(idx channels)
{
    return {.text = kernels::bake, .host = host_bake, .settings = {{"CHANNELS", channels}}};
}

void bake_by_rows(queue& q, const bake_source& s, std::span<const std::array<vec2, 3>> to, const bake_params& params,
                  const take_texels& take)
{
    params.validate();
    require_fitting(s, to.size());
    const texture image = shape_of_baked(s, params);
    const idx across = (image.width + bake_tile - 1) / bake_tile, down = (image.height + bake_tile - 1) / bake_tile;
    const auto places = new_places(s, to, params, image);
    const bake_buffers on(q, s, places, triangles_by_tile(places, bake_tile, across, down, bake_reach + 0.01), params);
    const kernel run = make_kernel(q, bake_program(image.channels), "bake_texels");
    const bake_frames frames = s.frames ? *s.frames : bake_frames{};

    // Some rows at a time, so that the new texture need not be on the device as a whole.
    const std::size_t width = usize(image.width), channels = usize(image.channels);
    const std::size_t most = std::max<std::size_t>(1, (std::size_t(1) << 22) / (width * channels));
    const idx band = static_cast<idx>(std::min(most, usize(image.height)));
    buffer<float> texels(q, width * usize(band) * channels);
    buffer<idx> covered(q, width * usize(band));
    std::vector<float> made(texels.size());
    std::vector<idx> marks(covered.size());
    for (idx first = 0; first < image.height; first += band)
    {
        const idx rows = std::min(band, image.height - first);
        const std::size_t count = width * usize(rows);
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
                                      {"source", kind_of(s)},
                                      {"old_uv", on.old_uv},
                                      {"old_texels", on.old_texels},
                                      {"old_table", on.old_table},
                                      {"old_bytes", s.old ? s.old->bytes : 4},
                                      {"palette", idx(s.old && s.old->palette)},
                                      {"old_width", s.old ? s.old->width : 1},
                                      {"old_height", s.old ? s.old->height : 1},
                                      {"nearest", idx(params.filter == texture::filter::nearest)},
                                      {"wrap_u", period_of(params.wrap)},
                                      {"wrap_v", period_of(params.wrap_v.value_or(params.wrap))},
                                      {"values", on.values},
                                      {"normals", on.normals},
                                      {"old_tangents", on.old_tangents},
                                      {"new_tangents", on.new_tangents},
                                      {"green", params.green_down ? -1.0 : 1.0},
                                      {"turn_x", std::cos(frames.before)},
                                      {"turn_y", std::sin(frames.before)},
                                      {"after_x", std::cos(frames.after)},
                                      {"after_y", std::sin(frames.after)},
                                      {"texels", texels},
                                      {"covered", covered}});
        texels.download(std::span(made).first(count * channels));
        covered.download(std::span(marks).first(count));
        take(first, rows, std::span<const float>(made).first(count * channels),
             std::span<const idx>(marks).first(count));
    }
}

baked_texture bake_any(queue& q, const bake_source& s, std::span<const std::array<vec2, 3>> to,
                       const bake_params& params)
{
    baked_texture result{shape_of_baked(s, params), {}};
    bake_by_rows(q, s, to, params,
                 [&](idx, idx, std::span<const float> texels, std::span<const idx> covered)
                 {
                     if (result.covered.empty())
                     {
                         result.image.texels.reserve(result.image.size());
                         result.covered.reserve(usize(result.image.width) * usize(result.image.height));
                     }
                     result.image.texels.insert(result.image.texels.end(), texels.begin(), texels.end());
                     for (const idx mark : covered) result.covered.push_back(static_cast<std::uint8_t>(mark));
                 });
    fill_gutters(result.image, result.covered, params.gutter);
    return result;
}

} // namespace taut::impl

namespace taut
{

baked_texture bake(queue& q, const texture& old, std::span<const std::array<vec2, 3>> from,
                   std::span<const std::array<vec2, 3>> to, const bake_params& params)
{
    old.validate("old");
    const impl::texture_rows rows = impl::rows_of(old);
    return impl::bake_any(q, {.old = &rows, .from = from}, to, params);
}

baked_texture bake(queue& q, std::span<const float> values, idx channels, std::span<const std::array<vec2, 3>> to,
                   const bake_params& params)
{
    return impl::bake_any(q, {.values = values, .channels = channels}, to, params);
}

baked_texture bake(queue& q, const texture& old, const bake_frames& frames, std::span<const std::array<vec2, 3>> from,
                   std::span<const std::array<vec2, 3>> to, const bake_params& params)
{
    old.validate("old");
    const impl::texture_rows rows = impl::rows_of(old);
    return impl::bake_any(q, {.old = &rows, .from = from, .frames = &frames}, to, params);
}

} // namespace taut
