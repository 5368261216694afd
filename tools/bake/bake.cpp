// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <bake/bake_options.hpp>
#include <bake/bake_report.hpp>
#include <bake/image_file.hpp>
#include <bake/model_images.hpp>
#include <bake/model_textures.hpp>
#include <bake/texture_baker.hpp>
#include <bake/texture_tiles.hpp>
#include <bake/textured_surface.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/gltf/images.hpp>

#include "commands.hpp"
#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/text_table.hpp"
#include "shared/tile_names.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

/// Adds files of tiles to those to be written.
void add_tiles(std::vector<io::file_to_write>& files, const std::string& path, std::map<idx, std::string> images)
{
    for (auto& [tile, bytes] : images)
        files.push_back(
            {path_of_tile(path, tile), [bytes = std::move(bytes)](io::atomic_file& out) { out.write(bytes); }});
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
        report_.bake = command_.clock.timed(
            [&]
            {
                texture_baker baker(*queue_, old_, new_, report_);
                if (options_.of_model())
                    bake_model(baker, files);
                else
                    bake_one(baker, files);
            });
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
        new_.uv = with_area(std::move(new_.uv));
        require_same_triangles(old_, new_);
        report_.triangles = old_.triangles.size();
        const auto require_places = [](const textured_surface& s, const char* what)
        {
            if (std::none_of(s.uv.begin(), s.uv.end(), has_place))
                throw unsuitable_input(s.path + ": has no " + what + "; `taut atlas` makes them");
        };
        if (!options_.colours_of_vertices) require_places(old_, "texture coordinates");
        require_places(new_, "texture coordinates in which a face has an area");
        for (std::size_t t = 0; t < new_.uv.size(); ++t)
            report_.left_out += !has_place(new_.uv[t]) || (!options_.colours_of_vertices && !has_place(old_.uv[t]));
    }

    /// What all textures have in common.
    bake_task task() const
    {
        bake_task task;
        task.to = new_.uv;
        task.params = to_params(options_);
        task.bits = options_.bits;
        return task;
    }

    /// One texture, or colours of vertices.
    void bake_one(texture_baker& baker, std::vector<io::file_to_write>& files)
    {
        bake_task one = task();
        one.content = options_.content;
        one.new_in_tiles = names_tiles(options_.output);
        one.extension = extension(options_.output);
        baked_files baked;
        if (options_.colours_of_vertices)
        {
            const auto read = read_vertex_colours(old_, options_.format);
            texture values{1, static_cast<idx>(read.values.size()) / read.channels, read.channels, read.values};
            if (one.content == texture_content::colour && !read.linear) to_linear(values);
            one.name = "colours of vertices";
            baked = baker.bake_corners(one, values.texels, values.channels);
        }
        else
        {
            one.name = options_.texture;
            one.from = old_.uv;
            one.old_in_tiles = names_tiles(options_.texture);
            if (!options_.difference.empty()) one.difference = extension(options_.difference);
            if (one.old_in_tiles && tiles_of(old_.uv).empty())
                throw unsuitable_input(old_.path + ": no face lies in a tile from 1001 on");
            one.load = [this](idx tile)
            {
                const std::string path = path_of_tile(options_.texture, tile);
                return read_image(io::impl::read_file(path), path);
            };
            baked = baker.bake(one);
        }
        if (baked.images.empty())
            throw unsuitable_input(new_.path + (one.new_in_tiles ? ": no face lies in a tile from 1001 on"
                                                                 : ": no face lies in the unit square"));
        note_outside(one);
        add_tiles(files, options_.output, std::move(baked.images));
        if (!options_.difference.empty()) add_tiles(files, options_.difference, std::move(baked.differences));
    }

    /// Notes faces that get no texels.
    void note_outside(const bake_task& one)
    {
        const auto tiles = tiles_of(new_.uv).size();
        if (!one.new_in_tiles && tiles > 1)
            report_.notes.push_back("the new atlas has " + std::to_string(tiles) +
                                    " tiles, but only the first has a texture; name it NAME.<UDIM>" +
                                    extension(options_.output));
        else if (const auto n = count_outside({new_.uv, one.new_in_tiles}); n > 0)
            report_.notes.push_back(count(n, "triangle lies", "triangles lie") + " outside of " +
                                    (one.new_in_tiles ? "its tile" : "the unit square") +
                                    " in the new atlas, in whole or in part, and what is there gets no texels");
        if (one.old_in_tiles)
            if (const auto n = std::count_if(old_.uv.begin(), old_.uv.end(),
                                             [](const auto& t) { return has_place(t) && !tile_of(t); });
                n > 0)
                report_.notes.push_back(count(static_cast<std::size_t>(n), "triangle lies", "triangles lie") +
                                        " in no tile of the old atlas, and gets no texels");
    }

    /// All textures of a model of glTF.
    void bake_model(texture_baker& baker, std::vector<io::file_to_write>& files)
    {
        const auto uses = textures_of(*old_.model, options_.texcoord_set, report_.notes);
        if (uses.empty())
            throw unsuitable_input(old_.path + ": its materials have no textures with TEXCOORD_" +
                                   std::to_string(options_.texcoord_set) + "; give --texture or --texcoord-set");
        if (options_.green_down &&
            std::none_of(uses.begin(), uses.end(),
                         [](const model_texture& use) { return use.content == texture_content::normal; }))
            throw unsuitable_input(old_.path + ": none of its textures are normals; leave out --green-down");
        require_same_textures(*old_.model, *new_.model, uses);
        const auto places = places_of_images(*new_.model, uses);
        io::impl::gltf_allowance bytes(old_.model->source, most_ways);
        std::vector<io::impl::new_image> images;
        for (std::size_t n = 0; n < uses.size(); ++n)
            images.push_back({places[n], bake_image(baker, uses[n], bytes), uses[n].name});
        for (auto& file : io::impl::files_with_images(options_.output, *new_.model, std::move(images),
                                                      [&](io::impl::gltf_json& document) {
                                                          show_images(document, *new_.model, uses, places, new_set(),
                                                                      report_.notes);
                                                      }))
            files.push_back(std::move(file));
    }

    /// The bytes of the new image of a use.
    std::string bake_image(texture_baker& baker, const model_texture& use, io::impl::gltf_allowance& allowance)
    {
        const auto& source = old_.model->source;
        bake_task one = task();
        one.name = use.name;
        one.content = use.content;
        one.rotation = use.rotation;
        one.params.wrap = use.wrap_u;
        one.params.wrap_v = use.wrap_v;
        if (!options_.given("--filter") && one.params.samples == 1)
            one.params.filter = use.filter;
        else if (!options_.given("--filter") && use.filter == texture::filter::nearest)
            report_.notes.push_back(use.name + ": is shown with the nearest texels, of which --samples takes no mean; "
                                               "it is taken between them");
        one.to.assign(new_.uv.size(), no_places);
        one.from = one.to;
        for (const auto& [first, part] : use.shown)
        {
            const corner_uv own = part.texcoords ? texcoords_of(*old_.model, first, part) : corner_uv();
            for (std::size_t t = first; t < first + part.count; ++t)
            {
                const auto& uv = part.texcoords ? own[t - first] : old_.uv[t];
                one.to[t] = new_.uv[t];
                one.from[t] = uv;
                for (vec2& x : one.from[t]) x = part.place(x);
                if (has_place(uv) && !has_place(one.from[t]))
                    throw unsuitable_input(old_.path + ": triangle " + std::to_string(t) +
                                           " is put beyond all numbers by KHR_texture_transform; correct it");
            }
        }
        if (count_outside({one.to, false}) > 0)
            throw unsuitable_input(new_.path +
                                   ": triangles lie outside of the unit square, and an image of glTF has no "
                                   "other tiles; make an atlas of one tile, without --udim");
        one.load = [&](idx)
        {
            const std::string bytes = io::impl::image_bytes(source, use.images.front());
            return read_image(bytes, use.name);
        };
        if (io::impl::item_of(source, "images", use.images.front()).find("bufferView"))
            allowance.take(io::impl::image_bytes(source, use.images.front()).size(), "bytes of images");
        auto baked = baker.bake(one);
        if (baked.images.empty())
            throw unsuitable_input(new_.path + ": no face that shows " + use.name + " has a place in both atlases");
        return std::move(baked.images.begin()->second);
    }

    static constexpr std::size_t most_ways = 16; // in which models use their images, all in all
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    static constexpr std::array<vec2, 3> no_places{vec2(nan), vec2(nan), vec2(nan)};

    const bake_options& options_;
    command_run command_;
    textured_surface old_, new_;
    std::optional<queue> queue_;
    bake_report report_;
};

} // namespace

command add_bake(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<bake_options>();
    declare(program.add_subcommand("bake", "Transfer textures from one UV atlas to another"), *options);
    return [options, launch](const outputs& files) { return bake_run(*options, files, launch)(); };
}

} // namespace taut::tools
