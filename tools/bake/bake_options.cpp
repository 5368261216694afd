// SPDX-License-Identifier: MIT
#include "bake/bake_options.hpp"

#include <charconv>
#include <optional>
#include <string_view>

#include <taut/gltf.hpp>

#include "shared/choices.hpp"
#include "shared/failure.hpp"
#include "shared/outputs.hpp"
#include "shared/shared_options.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools
{

namespace
{

/// N or WxH.
std::optional<std::pair<idx, idx>> size_of(std::string_view text)
{
    const auto whole = [](std::string_view digits)
    {
        idx n = 0;
        const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
        return fault == std::errc() && end == digits.data() + digits.size() && n >= 1 && n <= 32768 ? n : 0;
    };
    const auto cross = text.find('x');
    const idx width = whole(text.substr(0, cross));
    const idx height = cross == text.npos ? width : whole(text.substr(cross + 1));
    if (width == 0 || height == 0) return {};
    return std::pair(width, height);
}

void declare_pictures(const subcommand& app, bake_options& o)
{
    add_input(app, "--texture", o.texture, file_use{.read_as = "the texture", .tiles = true},
              "The texture of OLD: PNG, JPEG or EXR, NAME.<UDIM>.png for one per tile; default the textures of a "
              "glTF model");
    app.add_flag("--vertex-colours", o.colours_of_vertices, "Bake the colours of the vertices of OLD: PLY, OFF, glTF");
    add_output(app, "-o,--output", o.output,
               {.tiles = true, .extensions = {".png", ".exr", ".glb", ".gltf"}, .made_of = "NEW", .in_place = true},
               "The texture of NEW, NAME.<UDIM>.png for one per tile; or NEW with its textures, for glTF")
        .required()
        .type_name("OUT.png|.exr|.glb");
    add_choice<texture_content>(
        app, "--content", o.content,
        {{"colour", texture_content::colour}, {"data", texture_content::data}, {"normal", texture_content::normal}},
        "Content of the texture: sRGB colours, raw data, or normals in tangent space");
    add_choice<texture::filter>(app, "--filter", o.filter,
                                {{"bilinear", texture::filter::bilinear}, {"nearest", texture::filter::nearest}},
                                "Interpolation between old texels; nearest: for labels");
    add_choice<texture::wrap>(
        app, "--wrap", o.wrap,
        {{"repeat", texture::wrap::repeat}, {"clamp", texture::wrap::clamp}, {"mirror", texture::wrap::mirror}},
        "Continuation of the old texture beyond the unit square; mirror: every other copy is "
        "mirrored");
    app.add_option("--resolution", o.size, "Texels of the new texture, N or WIDTHxHEIGHT; default those of the old one")
        .type_name("N|WxH")
        .check([](const std::string& text)
               { return size_of(text) ? "" : text + " is no size from 1 to 32768, N or WxH"; });
    app.add_option("--samples", o.samples, "Samples along each side of a new texel, which are averaged")
        .type_name("N")
        .check_range(1, 8)
        .capture_default_str();
    app.add_option("--gutter", o.gutter, "Texels around charts that are filled from the nearest chart; default all")
        .type_name("PX")
        .check(number_that([](double x) { return x >= 0; }, "must not be negative"));
    app.add_option("--bits", o.bits, "Bits per channel in PNG, 8 or 16; default as the old texture")
        .type_name("N")
        .check_one_of({8, 16});
    app.add_flag("--green-down", o.green_down, "Green of normal maps grows downwards, as for DirectX");
}

} // namespace

void declare(const subcommand& app, bake_options& o)
{
    o.given = [app](const std::string& name) { return app.given(name); };
    add_input(app, "OLD", o.before, file_use{.read_as = "the old surface", .with_images = true},
              "The surface with the texture coordinates of the old texture: OBJ, OFF, PLY, glTF")
        .required();
    add_input(app, "NEW", o.after, "the new surface",
              "The same faces with new texture coordinates, as from `taut atlas`")
        .required();
    declare_pictures(app, o);
    add_output(app, "--difference", o.difference, {.tiles = true, .extensions = {".png", ".exr"}},
               "Draw the visible difference in the old atlas: times eight in .png, the numbers in .exr");
    add_format(app, o.format);
    app.add_option("--texcoord-set", o.texcoord_set, "N of TEXCOORD_N of OLD, for glTF")
        .type_name("N")
        .check_range(0, 7)
        .capture_default_str();
    app.add_option("--new-texcoord-set", o.new_texcoord_set, "N of TEXCOORD_N of NEW; default the same")
        .type_name("N")
        .check_range(0, 7);
    add_device(app, o.device);
    add_stats(app, o.stats);
    app.add_flag("--quiet", o.quiet, "Print errors only");
    app.footer("exit codes: 0 written; 2 usage; 3 unreadable input; 4 unsuitable input: other faces, no texture "
               "coordinates;\n  5 no device; 9 device failure");
}

namespace
{

/// Throws usage_error for options that say nothing, or what the model itself says.
void check_of_model(const bake_options& o)
{
    if (o.given("--texcoord-set") && !io::is_gltf(o.before) && !io::is_gltf(o.after))
        throw usage_error("--texcoord-set is for glTF; leave it out");
    if (o.given("--format") && io::is_gltf(o.before))
        throw usage_error("--format is for OBJ, OFF, PLY and STL; leave it out for glTF");
    if (o.given("--new-texcoord-set") && !io::is_gltf(o.after))
        throw usage_error("--new-texcoord-set is for glTF; leave it out");
    if (!o.of_model())
    {
        if (o.green_down && o.content != texture_content::normal)
            throw usage_error("--green-down is for normals; give --content normal, or leave it out");
        return;
    }
    if (o.given("--content"))
        throw usage_error(
            "--content: materials determine the content of their textures; leave it out, or give --texture");
    if (o.given("--wrap"))
        throw usage_error("--wrap: the model determines how its textures continue; leave it out, or give --texture");
}

} // namespace

void check(const bake_options& o)
{
    const bool into_model = io::is_gltf(o.output);
    if (!o.texture.empty() && o.colours_of_vertices)
        throw usage_error("--texture and --vertex-colours: give one of them");
    if (o.of_model() && !(io::is_gltf(o.before) && io::is_gltf(o.after)))
        throw usage_error("give --texture, or --vertex-colours; only models of glTF name their textures");
    if (o.of_model() && !into_model)
        throw usage_error("-o " + o.output +
                          ": a model of glTF is written as .glb or .gltf; name it so, or give "
                          "--texture");
    if (!o.of_model() && into_model)
        throw usage_error("-o " + o.output + ": one texture is written as .png or .exr; name it so");
    if (o.of_model() && !o.difference.empty()) throw usage_error("--difference is for one texture; give --texture");
    if (o.filter == texture::filter::nearest && o.samples > 1)
        throw usage_error("--samples: labels have no mean; leave it out with --filter nearest");
    if (o.colours_of_vertices && o.content == texture_content::normal)
        throw usage_error("--content normal is for textures; leave it out with --vertex-colours");
    if (o.colours_of_vertices && !o.difference.empty())
        throw usage_error("--difference is for textures; leave it out with --vertex-colours");
    if (o.colours_of_vertices && (o.given("--filter") || o.given("--wrap")))
        throw usage_error("--filter and --wrap are for textures; leave them out with --vertex-colours");
    check_of_model(o);
    if (o.given("--wrap") && names_tiles(o.texture))
        throw usage_error("--wrap: the texture of a tile ends at its border; leave it out with <UDIM>");
    if (names_tiles(o.texture) && !o.difference.empty() && !names_tiles(o.difference))
        throw usage_error("--difference is drawn for each tile of --texture; name it NAME.<UDIM>.png");
    if (o.bits > 0 && extension(o.output) == ".exr") throw usage_error("--bits is for PNG; EXR has floats");
}

bake_params to_params(const bake_options& o)
{
    bake_params params;
    if (const auto size = size_of(o.size))
    {
        params.width = size->first;
        params.height = size->second;
    }
    params.filter = o.filter;
    params.wrap = o.wrap;
    params.samples = o.samples;
    params.gutter = o.gutter;
    params.green_down = o.green_down;
    return params;
}

} // namespace taut::tools
