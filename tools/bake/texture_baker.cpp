// SPDX-License-Identifier: MIT
#include "bake/texture_baker.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <taut/bake.hpp>
#include <taut/impl/charts/bake/bake.hpp>
#include <taut/impl/charts/bake/compare_textures.hpp>
#include <taut/impl/charts/bake/fill_gutters.hpp>

#include "shared/at.hpp"
#include "shared/failure.hpp"
#include "shared/png.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

template <class T>
std::vector<T> some_of(const std::vector<T>& all, std::span<const idx> which)
{
    std::vector<T> some;
    some.reserve(which.size());
    for (const idx t : which) some.push_back(all[at(t)]);
    return some;
}

/// Places of some triangles, moved from a tile to the unit square.
corner_uv places_of(const corner_uv& uv, std::span<const idx> which, idx tile)
{
    corner_uv some = some_of(uv, which);
    for (auto& t : some)
        for (vec2& x : t) x -= corner_of(tile);
    return some;
}

/// The largest difference of all channels of each texel, eight times as bright; or the numbers.
std::string difference_picture(const texture& difference, const std::string& extension)
{
    if (extension == ".exr") return encode_exr(difference);
    texture shown{difference.width, difference.height, 1, {}};
    const auto channels = static_cast<std::size_t>(difference.channels);
    for (std::size_t n = 0; n < difference.texels.size(); n += channels)
    {
        const auto first = difference.texels.begin() + static_cast<std::ptrdiff_t>(n);
        shown.texels.push_back(8 * *std::max_element(first, first + static_cast<std::ptrdiff_t>(channels)));
    }
    round_to(shown, image_numbers::bytes);
    return encode_png(shown, image_numbers::bytes);
}

/// Bits of a number in a new PNG file.
int bits_of(const bake_task& task, image_numbers numbers)
{
    return task.bits > 0 ? task.bits : numbers == image_numbers::bytes ? 8 : 16;
}

/// Throws unsuitable_input where a new texture is more than its file holds.
void require_room(const bake_task& task, idx width, idx height, idx channels, image_numbers numbers)
{
    const int bits = bits_of(task, numbers);
    if (task.extension == ".exr" || fits_png(width, height, channels, bits)) return;
    throw unsuitable_input(task.name + ": " + std::to_string(width) + " x " + std::to_string(height) + " texels of " +
                           std::to_string(channels) + " channels of " + std::to_string(bits) +
                           " bits are more than the 2 GiB that a PNG holds; give a smaller --resolution" +
                           (bits == 16 && fits_png(width, height, channels, 8) ? ", --bits 8" : "") +
                           " or name the output .exr");
}

/// Takes rows into a texture as a whole.
impl::take_texels taken_by(baked_texture& whole)
{
    return [&whole](idx, idx, std::span<const float> texels, std::span<const idx> covered)
    {
        if (whole.covered.empty())
        {
            whole.image.texels.reserve(whole.image.size());
            whole.covered.reserve(whole.image.size() / at(whole.image.channels));
        }
        whole.image.texels.insert(whole.image.texels.end(), texels.begin(), texels.end());
        whole.covered.insert(whole.covered.end(), covered.begin(), covered.end());
    };
}

} // namespace

std::shared_ptr<const image_file> texture_baker::decoded_images::at(idx tile)
{
    constexpr std::size_t most = std::size_t(1) << 28; // bytes
    const auto known = std::find_if(kept_.begin(), kept_.end(), [tile](const auto& k) { return k.first == tile; });
    if (known != kept_.end())
    {
        std::rotate(known, known + 1, kept_.end());
        return kept_.back().second;
    }
    const auto bytes_of = [](const image_file& f) { return f.rows.bytes_of_row() * tools::at(f.rows.height); };
    std::size_t bytes = 0;
    for (auto k = kept_.rbegin(); k != kept_.rend(); ++k)
        if ((bytes += bytes_of(*k->second)) > most / 2)
        {
            kept_.erase(kept_.begin(), k.base());
            break;
        }
    kept_.emplace_back(tile, std::make_shared<const image_file>(load_(tile)));
    return kept_.back().second;
}

image_file texture_baker::load_old(const bake_task& task, idx tile)
{
    image_file file = task.load(tile);
    if (task.content == texture_content::colour && file.numbers != image_numbers::floats) to_linear(file.rows);
    if (is_turned(task.content) && file.rows.channels < 3)
        throw unsuitable_input(task.name + ": " +
                               (task.content == texture_content::normal ? "normals" : "directions and their strength") +
                               " have three channels; give --content data");
    if (channels_ > 0 && channels_ != file.rows.channels)
        throw unsuitable_input(task.name + ": has another number of channels in tile " + std::to_string(1001 + tile) +
                               " than in the first one; convert it");
    channels_ = file.rows.channels;
    return file;
}

image_file texture_baker::load_new(const bake_task& task, const baked_files& files, idx tile) const
{
    image_file file = read_image(files.images.at(tile), task.name);
    if (task.content == texture_content::colour && file.numbers != image_numbers::floats) to_linear(file.rows);
    return file;
}

texture_baker::tangents texture_baker::tangents_of(const bake_task& task) const
{
    if (!is_turned(task.content)) return {};
    const auto& normals = old_.has_normals ? old_.normals : new_.normals;
    tangents made{tangent_frames(old_.points, old_.triangles, normals, task.from),
                  tangent_frames(old_.points, old_.triangles, normals, task.to)};
    for (std::size_t t = 0; t < old_.tangents.size(); ++t)
        if (const auto& own = old_.tangents[t];
            std::all_of(own.begin(), own.end(), [](const auto& x) { return std::isfinite(x.x + x.y + x.z); }))
            made.old[t] = own;
    return made;
}

/// Bakes some triangles of an image of `other_tile` into `tile`, of the new atlas or back into one of the old atlas.
void texture_baker::bake_rows(const bake_task& task, bool back, std::span<const idx> triangles, const image_file& image,
                              idx tile, idx other_tile, const bake_params& params, const impl::take_texels& take)
{
    const corner_uv from = places_of(back ? task.to : task.from, triangles, other_tile),
                    to = places_of(back ? back_to_ : task.to, triangles, tile);
    impl::bake_source source{.old = &image.rows, .from = from, .numbers = triangles};
    bake_frames frames;
    std::vector<std::array<vec3, 3>> normals;
    tangents own;
    if (is_turned(task.content))
    {
        normals = some_of(old_.has_normals ? old_.normals : new_.normals, triangles);
        own = {some_of(tangents_.old, triangles), some_of(tangents_.next, triangles)};
        if (back) std::swap(own.old, own.next);
        frames = {normals,
                  own.old,
                  own.next,
                  task.content == texture_content::direction,
                  back ? 0 : task.rotation,
                  back ? -task.rotation : 0};
        source.frames = &frames;
    }
    try
    {
        impl::bake_by_rows(queue_, source, to, params, take);
    }
    catch (const parameter_error& e) // of what the files have
    {
        if (e.field() != "from") throw;
        throw unsuitable_input((back ? new_.path : old_.path) + ": " +
                               std::string(e.what()).substr(std::string("parameter from: ").size()));
    }
}

/// One tile, from all of the other atlas that its triangles are in.
baked_texture texture_baker::bake_tile(const bake_task& task, bool back, const std::map<idx, std::vector<idx>>& parts,
                                       idx tile, bake_params params, decoded_images& images)
{
    if (back ? task.new_in_tiles : task.old_in_tiles) params.wrap = texture::wrap::clamp, params.wrap_v.reset();
    if (params.width == 0)
        for (const auto& [other, triangles] : parts) // as fine as the finest
        {
            const auto rows = images.at(other);
            params.width = std::max(params.width, rows->rows.width);
            params.height = std::max(params.height, rows->rows.height);
        }
    baked_texture whole;
    for (const auto& [other, triangles] : parts)
    {
        const auto image = images.at(other);
        if (!back) require_room(task, params.width, params.height, image->rows.channels, image->numbers);
        baked_texture part{{params.width, params.height, image->rows.channels, {}}, {}};
        bake_rows(task, back, triangles, *image, tile, other, params, taken_by(part));
        if (whole.covered.empty())
            whole = std::move(part);
        else
            merge(whole, part);
    }
    return whole;
}

/// Encodes a new texture, and counts what it is.
std::string texture_baker::finished(const bake_task& task, baked_texture& baked, image_numbers numbers)
{
    texture& image = baked.image;
    baked_report& told = report_.textures.back();
    std::string bytes;
    if (task.extension == ".exr")
        bytes = encode_exr(image);
    else
    {
        numbers = bits_of(task, numbers) == 8 ? image_numbers::bytes : image_numbers::shorts;
        if (task.content == texture_content::colour) to_srgb(image);
        const double rounding = numbers == image_numbers::bytes ? 0.5 / 255 : 0.5 / 65535;
        const auto channels = static_cast<std::size_t>(image.channels);
        for (std::size_t n = 0; n < baked.covered.size(); ++n)
        {
            if (baked.covered[n] == 0) continue;
            const auto texel = std::span<const float>(image.texels).subspan(n * channels, channels);
            const auto [low, high] = std::minmax_element(texel.begin(), texel.end());
            const bool is_number = std::all_of(texel.begin(), texel.end(), [](float x) { return std::isfinite(x); });
            not_numbers_ += !is_number;
            if (!is_number || (*low >= -rounding && *high <= 1 + rounding)) continue;
            ++cut_off_;
            low_ = std::min<double>(low_, *low);
            high_ = std::max<double>(high_, *high);
        }
        round_to(image, numbers);
        bytes = encode_png(image, numbers);
    }
    told.name = task.name;
    told.content = task.content;
    told.width = std::max(told.width, image.width);
    told.height = std::max(told.height, image.height);
    told.channels = image.channels;
    told.bytes += bytes.size();
    told.texels += baked.covered.size();
    told.covered += static_cast<std::size_t>(std::count(baked.covered.begin(), baked.covered.end(), 1));
    ++told.tiles;
    return bytes;
}

/// Compares old textures with what the new ones give back of them, a few rows at a time.
void texture_baker::compare(const bake_task& task, const triangles_of_tiles& parts, decoded_images& old,
                            baked_files& files)
{
    std::map<idx, std::map<idx, std::vector<idx>>> of_old;
    for (const auto& [tile, others] : parts)
        for (const auto& [other, triangles] : others) of_old[other][tile] = triangles;
    decoded_images made([&](idx tile) { return load_new(task, files, tile); });
    impl::difference_sum sum(channels_);
    for (const auto& [tile, others] : of_old)
    {
        const auto image = old.at(tile);
        const impl::texture_rows& rows = image->rows;
        const auto width = static_cast<std::size_t>(rows.width), channels = static_cast<std::size_t>(rows.channels);
        texture shown{rows.width, rows.height, rows.channels, {}};
        if (!task.difference.empty()) shown.texels.assign(shown.size(), 0.0f);
        std::vector<float> before(width * channels), differences(channels);
        const auto look = [&](idx first, idx count, std::span<const float> texels, const auto& covered)
        {
            for (std::size_t j = 0; j < at(count); ++j)
            {
                const auto marks = covered.subspan(j * width, width);
                if (std::find(marks.begin(), marks.end(), 1) == marks.end()) continue;
                rows.values(first + static_cast<idx>(j), before.data());
                for (std::size_t i = 0; i < width; ++i)
                {
                    if (marks[i] != 1) continue;
                    float* const to = shown.texels.empty() ? differences.data()
                                                           : &shown.texels[((at(first) + j) * width + i) * channels];
                    sum.add(&before[i * channels], &texels[(j * width + i) * channels], to);
                }
            }
        };
        bake_params back = task.params;
        back.samples = 1;
        back.width = rows.width;
        back.height = rows.height;
        if (others.size() > 1) // each has a part of it
        {
            const baked_texture whole = bake_tile(task, true, others, tile, back, made);
            look(0, rows.height, whole.image.texels, std::span<const std::uint8_t>(whole.covered));
        }
        else
        {
            const auto& [other, triangles] = *others.begin();
            if (task.new_in_tiles) back.wrap = texture::wrap::clamp, back.wrap_v.reset();
            bake_rows(task, true, triangles, *made.at(other), tile, other, back, look);
        }
        if (!shown.texels.empty()) files.differences.emplace(tile, difference_picture(shown, task.difference));
    }
    const auto found = sum.result();
    baked_report& told = report_.textures.back();
    told.compared = found.texels;
    told.unlike = found.unlike;
    if (found.texels == 0)
        report_.notes.push_back(task.name + ": the faces have no area in the old atlas, so that nothing is compared");
    else
    {
        told.largest = found.largest;
        told.rms = found.rms;
    }
}

/// Tells what the files do not hold.
void texture_baker::note_cut_off(const bake_task& task)
{
    const auto texels = [](std::size_t n) { return count(n, "texel has", "texels have"); };
    if (cut_off_ > 0)
        report_.notes.push_back(task.name + ": " + texels(cut_off_) + " numbers that PNG does not hold, from " +
                                number(low_, 4) + " to " + number(high_, 4) +
                                "; they are cut off at 0 and 1, name the output .exr to keep them");
    if (not_numbers_ > 0)
        report_.notes.push_back(task.name + ": " + texels(not_numbers_) +
                                " something that is no number, and is 0 or 1 in PNG; name the output .exr to keep it");
    cut_off_ = not_numbers_ = 0;
    low_ = 0, high_ = 1;
}

baked_files texture_baker::bake_corners(const bake_task& task, std::span<const float> values, idx channels)
{
    report_.textures.emplace_back();
    baked_files files;
    for (const auto& [tile, all] : triangles_by_tiles({task.to, false}, {task.to, task.new_in_tiles}))
    {
        if (task.params.width > 0)
            require_room(task, task.params.width, task.params.height, channels, image_numbers::bytes);
        const auto& triangles = all.at(0);
        const auto n = 3 * at(channels);
        std::vector<float> some;
        for (const idx t : triangles)
            some.insert(some.end(), values.begin() + static_cast<std::ptrdiff_t>(n * at(t)),
                        values.begin() + static_cast<std::ptrdiff_t>(n * (at(t) + 1)));
        baked_texture whole = impl::bake_any(queue_, {.values = some, .channels = channels},
                                             places_of(task.to, triangles, tile), task.params);
        files.images.emplace(tile, finished(task, whole, image_numbers::bytes));
    }
    note_cut_off(task);
    return files;
}

baked_files texture_baker::bake(const bake_task& task)
{
    channels_ = 0;
    tangents_ = tangents_of(task);
    back_to_ = with_area(task.from);
    const auto parts = triangles_by_tiles({task.from, task.old_in_tiles}, {task.to, task.new_in_tiles});
    decoded_images old([&](idx tile) { return load_old(task, tile); });
    report_.textures.emplace_back();
    baked_files files;
    for (const auto& [tile, others] : parts)
    {
        baked_texture whole = bake_tile(task, false, others, tile, task.params, old);
        impl::fill_gutters(whole.image, whole.covered, task.params.gutter);
        auto numbers = image_numbers::bytes;
        for (const auto& part : others) numbers = std::max(numbers, old.at(part.first)->numbers);
        files.images.emplace(tile, finished(task, whole, numbers));
    }
    if (files.images.empty()) return files;
    note_cut_off(task);
    compare(task, parts, old, files);
    return files;
}

} // namespace taut::tools
