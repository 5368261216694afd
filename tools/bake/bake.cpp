// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <bake/bake_options.hpp>
#include <bake/image_file.hpp>
#include <bake/model_textures.hpp>
#include <bake/texture_tiles.hpp>
#include <bake/textured_surface.hpp>
#include <taut/impl/bake/bake.hpp>
#include <taut/impl/bake/compare_textures.hpp>
#include <taut/impl/gltf/images.hpp>
#include <taut/impl/io/read_file.hpp>

#include "commands.hpp"
#include "shared/assessment.hpp"
#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/png.hpp"
#include "shared/printable.hpp"
#include "shared/text_table.hpp"
#include "shared/tile_names.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

bool has_place(const std::array<vec2, 3>& t)
{
    return std::all_of(t.begin(), t.end(), [](const vec2& x) { return std::isfinite(x.x) && std::isfinite(x.y); });
}

/// What a run says of one texture.
struct baked_report
{
    std::string name;
    texture_content content = texture_content::colour;
    idx width = 0, height = 0, channels = 0;
    std::size_t tiles = 1;
    double covered = 0;                 ///< part of the new texture
    std::optional<double> largest, rms; ///< differences through both atlases, from 0 to 1
    std::size_t compared = 0;           ///< texels
};

struct bake_report
{
    std::string device, device_label;
    std::size_t triangles = 0, left_out = 0;
    std::vector<baked_report> textures;
    std::vector<std::string> notes;
    double read = 0, bake = 0, write = 0, total = 0;
};

const char* word_of(texture_content content)
{
    return content == texture_content::colour ? "colour" : content == texture_content::normal ? "normal" : "data";
}

nlohmann::ordered_json to_json(const bake_report& r, const bake_options& o)
{
    nlohmann::ordered_json json;
    json["schema"] = "taut.bake/1";
    json["old"] = o.before;
    json["new"] = o.after;
    json["output"] = o.output;
    json["device"] = r.device;
    json["faces"] = r.triangles;
    json["left_out"] = r.left_out;
    json["textures"] = nlohmann::ordered_json::array();
    for (const auto& t : r.textures)
    {
        nlohmann::ordered_json texture{{"name", t.name},      {"content", word_of(t.content)}, {"width", t.width},
                                       {"height", t.height},  {"channels", t.channels},        {"tiles", t.tiles},
                                       {"covered", t.covered}};
        texture["largest_difference"] = t.largest ? finite(*t.largest) : nullptr;
        texture["rms_difference"] = t.rms ? finite(*t.rms) : nullptr;
        texture["compared_texels"] = t.compared;
        json["textures"].push_back(std::move(texture));
    }
    json["seconds"] = {{"read", r.read}, {"bake", r.bake}, {"write", r.write}, {"total", r.total}};
    json["notes"] = r.notes;
    return json;
}

std::string text_of(const bake_report& r, const bake_options& o)
{
    for (const auto& note : r.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    labelled_lines lines;
    lines.add("surface", o.before + " -> " + o.after + ": " + count(r.triangles, "triangle", "triangles") +
                             (r.left_out > 0 ? ", " + count(r.left_out) + " left out" : ""));
    lines.add("device", r.device_label);
    for (const auto& t : r.textures)
        lines.add("texture",
                  t.name + ": " + word_of(t.content) + ", " + std::to_string(t.width) + " x " +
                      std::to_string(t.height) + (t.tiles > 1 ? ", " + std::to_string(t.tiles) + " tiles, " : ", ") +
                      number(100 * t.covered, 3) + " % covered" +
                      (t.largest
                           ? "; through both atlases rms " + number(*t.rms, 3) + ", at most " + number(*t.largest, 3)
                           : ""));
    lines.add("time", duration(r.total) + ": read " + duration(r.read) + ", bake " + duration(r.bake) + ", write " +
                          duration(r.write));
    lines.add_written({o.output, o.difference, o.stats});
    std::ostringstream out;
    out << lines;
    return out.str();
}

/// One run of `taut bake`.
class bake_run
{
public:
    bake_run(const bake_options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
        : options_(options), command_(options, files, launch)
    {
    }

    exit_code operator()()
    {
        report_.read = command_.clock.timed([&] { read(); });
        queue_.emplace(open_queue(options_.device, false));
        report_.device = queue_->device().name();
        report_.device_label = (std::ostringstream() << queue_->device()).str();
        std::vector<io::file_to_write> files;
        if (options_.of_model())
            bake_model(files);
        else
            bake_one(files);
        command_.write(std::move(files), report_, options_,
                       [&](double total, double write) { report_.total = total, report_.write = write; });
        return exit_code::valid;
    }

private:
    int new_set() const { return options_.new_texcoord_set < 0 ? options_.texcoord_set : options_.new_texcoord_set; }

    void read()
    {
        old_ = read_textured_surface(options_.before, options_.format, options_.texcoord_set);
        new_ = read_textured_surface(options_.after, io::surface_format::automatic, new_set());
        require_same_triangles(old_, new_);
        report_.triangles = old_.triangles.size();
        const auto require_places = [](const textured_surface& s)
        {
            if (std::none_of(s.uv.begin(), s.uv.end(), has_place))
                throw unsuitable_input(s.path + ": has no texture coordinates; `taut atlas` makes them");
        };
        if (!options_.colours_of_vertices) require_places(old_);
        require_places(new_);
        for (std::size_t t = 0; t < new_.uv.size(); ++t)
            report_.left_out += !has_place(new_.uv[t]) || (!options_.colours_of_vertices && !has_place(old_.uv[t]));
    }

    /// Bakes textures of linear numbers, and looks at them through both atlases.
    std::map<idx, baked_texture> bake_textures(const tile_set& old, texture_content content, const corner_uv& from,
                                               const corner_uv& to, const bake_params& params, const std::string& name,
                                               bool several = false)
    {
        const bool normals = content == texture_content::normal;
        if (normals && old.images.begin()->second.channels < 3)
            throw unsuitable_input(name + ": normals have three channels; give --content data");
        if (normals) make_frames(from, to);
        const auto& of_corners = old_.has_normals ? old_.normals : new_.normals;
        const auto one = [&](const corner_uv& other, const impl::bake_frames& frames)
        {
            return [this, normals, frames, other = &other](const texture& image, const corner_uv& own,
                                                           const bake_params& how)
            {
                try
                {
                    return normals ? bake(*queue_, image, frames, own, *other, how)
                                   : bake(*queue_, image, own, *other, how);
                }
                catch (const parameter_error& e) // of what the files have
                {
                    if (e.field() != "from") throw;
                    throw unsuitable_input((&own == &new_.uv ? new_.path : old_.path) + ": " +
                                           std::string(e.what()).substr(std::string("parameter from: ").size()));
                }
            };
        };
        std::map<idx, baked_texture> result;
        report_.bake += command_.clock.timed(
            [&]
            {
                result =
                    bake_tiles(old, from, to, several, params, one(to, {of_corners, old_tangents_, new_tangents_}));
                note(name, content, result);
                tile_set made{several, {}};
                for (const auto& [tile, baked] : result) made.images.emplace(tile, baked.image);
                bake_params back = params;
                back.samples = 1;
                compare(old, bake_tiles_like(old, made, to, from, back,
                                             one(from, {of_corners, new_tangents_, old_tangents_})));
            });
        return result;
    }

    /// The textures of `made` in the tiles and sizes of the old ones.
    static std::map<idx, baked_texture> bake_tiles_like(const tile_set& old, const tile_set& made,
                                                        const corner_uv& from, const corner_uv& to, bake_params params,
                                                        const auto& one)
    {
        params.width = old.images.begin()->second.width;
        params.height = old.images.begin()->second.height;
        return bake_tiles(made, from, to, old.several, params, one);
    }

    /// Compares old textures with what came back of them.
    void compare(const tile_set& old, const std::map<idx, baked_texture>& returned)
    {
        baked_report& told = report_.textures.back();
        differences_.clear();
        double squares = 0;
        for (const auto& [tile, image] : old.images)
        {
            const auto at = returned.find(tile);
            if (at == returned.end() || at->second.image.texels.size() != image.texels.size()) continue;
            auto compared = at->second.covered;
            for (auto& mark : compared) mark = mark == 1;
            auto d = compare_textures(image, at->second.image, compared);
            told.largest = std::max(told.largest.value_or(0), d.largest);
            told.compared += d.texels;
            squares += d.rms * d.rms * static_cast<double>(d.texels);
            differences_.emplace(tile, std::move(d.image));
        }
        if (told.compared > 0)
            told.rms = std::sqrt(squares / static_cast<double>(told.compared));
        else
            told.largest.reset();
    }

    void note(const std::string& name, texture_content content, const std::map<idx, baked_texture>& baked)
    {
        baked_report told;
        told.name = name;
        told.content = content;
        told.tiles = baked.size();
        for (const auto& [tile, one] : baked)
        {
            told.width = one.image.width;
            told.height = one.image.height;
            told.channels = one.image.channels;
            told.covered += static_cast<double>(std::count(one.covered.begin(), one.covered.end(), 1)) /
                            static_cast<double>(one.covered.size() * baked.size());
        }
        report_.textures.push_back(std::move(told));
    }

    void make_frames(const corner_uv& from, const corner_uv& to)
    {
        const auto& normals = old_.has_normals ? old_.normals : new_.normals;
        old_tangents_ =
            old_.tangents.empty() ? tangent_frames(old_.points, old_.triangles, normals, from) : old_.tangents;
        new_tangents_ = tangent_frames(old_.points, old_.triangles, normals, to);
    }

    std::string encoded(const texture& image, image_numbers numbers) const
    {
        return extension(options_.output) == ".exr" ? encode_exr(image) : encode_png(image, numbers);
    }

    image_numbers numbers_for(image_numbers old) const
    {
        if (options_.bits == 8) return image_numbers::bytes;
        return options_.bits == 16 || old == image_numbers::floats ? image_numbers::shorts : old;
    }

    /// One texture, or colours of vertices.
    void bake_one(std::vector<io::file_to_write>& files)
    {
        std::map<idx, baked_texture> baked;
        image_numbers numbers = image_numbers::bytes;
        // Colours are stored linear in EXR alone.
        const bool colours = options_.content == texture_content::colour, several = names_tiles(options_.output);
        if (options_.colours_of_vertices)
        {
            const auto read = read_vertex_colours(old_, options_.format);
            texture values{1, static_cast<idx>(read.values.size()) / read.channels, read.channels, read.values};
            if (colours && !read.linear) to_linear(values);
            const auto one = [&](const texture& x, const corner_uv&, const bake_params& how)
            { return bake(*queue_, x.texels, x.channels, new_.uv, how); };
            report_.bake += command_.clock.timed(
                [&] {
                    baked = bake_tiles({false, {{0, values}}}, {}, new_.uv, several, to_params(options_), one);
                });
            note("colours of vertices", options_.content, baked);
        }
        else
        {
            tile_set old{names_tiles(options_.texture), {}};
            for (const idx tile : old.several ? tiles_of(old_.uv) : std::set<idx>{0})
            {
                const std::string path = path_of_tile(options_.texture, tile);
                auto file = read_image(io::impl::read_file(path), path);
                numbers = std::max(numbers, file.numbers);
                if (colours && file.numbers != image_numbers::floats) to_linear(file.image);
                if (!old.images.empty() && old.images.begin()->second.channels != file.image.channels)
                    throw unsuitable_input(path + ": has another number of channels than the first tile; convert it");
                old.images.emplace(tile, std::move(file.image));
            }
            if (old.images.empty()) throw unsuitable_input(old_.path + ": no face lies in a tile from 1001 on");
            baked =
                bake_textures(old, options_.content, old_.uv, new_.uv, to_params(options_), options_.texture, several);
        }
        if (baked.empty()) throw unsuitable_input(new_.path + ": no face lies in a tile from 1001 on");
        if (const auto tiles = tiles_of(new_.uv).size(); !several && tiles > 1)
            report_.notes.push_back("the new atlas has " + std::to_string(tiles) +
                                    " tiles, of which the first alone has a texture; name it NAME.<UDIM>" +
                                    extension(options_.output));
        for (auto& [tile, one] : baked)
        {
            if (colours && extension(options_.output) != ".exr") to_srgb(one.image);
            files.push_back({path_of_tile(options_.output, tile),
                             [this, image = std::move(one.image), numbers](io::atomic_file& out)
                             { out.write(encoded(image, numbers_for(numbers))); }});
        }
        if (!options_.difference.empty())
            for (const auto& [tile, image] : differences_)
                files.push_back({path_of_tile(options_.difference, tile), [this, &image = image](io::atomic_file& out)
                                 { out.write(difference_picture(image)); }});
    }

    /// The largest difference of all channels of each texel, eight times as bright; or the numbers.
    std::string difference_picture(const texture& difference) const
    {
        if (extension(options_.difference) == ".exr") return encode_exr(difference);
        texture shown{difference.width, difference.height, 1, {}};
        const auto channels = static_cast<std::size_t>(difference.channels);
        for (std::size_t n = 0; n < difference.texels.size(); n += channels)
        {
            const auto first = difference.texels.begin() + static_cast<std::ptrdiff_t>(n);
            shown.texels.push_back(8 * *std::max_element(first, first + static_cast<std::ptrdiff_t>(channels)));
        }
        return encode_png(shown, image_numbers::bytes);
    }

    /// All textures of a model of glTF.
    void bake_model(std::vector<io::file_to_write>& files)
    {
        const auto& source = old_.model->source;
        const auto uses = textures_of(*old_.model, options_.texcoord_set, report_.notes);
        if (uses.empty())
            throw unsuitable_input(old_.path + ": its materials have no textures with TEXCOORD_" +
                                   std::to_string(options_.texcoord_set) + "; give --texture or --texcoord-set");
        if (options_.green_down &&
            std::none_of(uses.begin(), uses.end(),
                         [](const model_texture& use) { return use.content == texture_content::normal; }))
            throw unsuitable_input(old_.path + ": none of its textures are normals; leave out --green-down");
        for (const char* const list : {"materials", "textures", "images"})
            if (io::impl::root_of(source).items(list).size() !=
                io::impl::root_of(new_.model->source).items(list).size())
                throw unsuitable_input(old_.path + " and " + new_.path + " have other numbers of " + list +
                                       ": NEW is to be made of OLD, as by `taut atlas OLD -o NEW`");
        std::vector<io::impl::new_image> images;
        std::vector<std::size_t> numbers;
        std::size_t next = io::impl::root_of(source).items("images").size();
        for (const model_texture& use : uses)
        {
            const bool first = std::find(numbers.begin(), numbers.end(), use.image) == numbers.end();
            numbers.push_back(first ? use.image : next++);
            images.push_back({numbers.back(), bake_image(use)});
        }
        for (auto& file : io::impl::files_with_images(options_.output, *new_.model, std::move(images),
                                                      [&](io::impl::gltf_json& document)
                                                      { show_images(document, uses, numbers, new_set()); }))
            files.push_back(std::move(file));
    }

    /// The bytes of the new image of a use.
    std::string bake_image(const model_texture& use)
    {
        auto file = read_image(io::impl::image_bytes(old_.model->source, use.image), use.name);
        const bool colours = use.content == texture_content::colour;
        if (colours) to_linear(file.image);
        auto from = old_.uv;
        for (auto& t : from)
            for (vec2& x : t) x = use.place(x);
        corner_uv to(new_.uv.size());
        for (auto& t : to) t.fill(vec2(std::numeric_limits<double>::quiet_NaN()));
        for (const auto& [first, number] : use.shown)
            std::copy_n(new_.uv.begin() + static_cast<std::ptrdiff_t>(first), number,
                        to.begin() + static_cast<std::ptrdiff_t>(first));
        auto params = to_params(options_);
        params.wrap = use.wrap;
        const tile_set old{false, {{0, std::move(file.image)}}};
        auto baked = std::move(bake_textures(old, use.content, from, to, params, use.name).at(0));
        if (colours) to_srgb(baked.image);
        return encode_png(baked.image, numbers_for(file.numbers));
    }

    const bake_options& options_;
    command_run command_;
    textured_surface old_, new_;
    std::optional<queue> queue_;
    std::vector<impl::corner_tangents> old_tangents_, new_tangents_;
    std::map<idx, texture> differences_; // of the last texture, by tile
    bake_report report_;
};

} // namespace

command add_bake(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<bake_options>();
    declare(program.add_subcommand("bake", "Make the textures of an atlas anew for another one"), *options);
    return [options, launch](const outputs& files) { return bake_run(*options, files, launch)(); };
}

} // namespace taut::tools
