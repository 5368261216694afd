// SPDX-License-Identifier: MIT
#include "atlas/atlas_options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <set>

#include <taut/gltf.hpp>

#include "atlas/part_densities.hpp"
#include "shared/choices.hpp"
#include "shared/failure.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

void declare_charts(const subcommand& app, atlas_options& o)
{
    app.add_flag("--repair", o.repair,
                 "Repair the input: duplicate and degenerate triangles, non-manifold edges, "
                 "winding, ...; the files keep their vertices and faces, removed faces have no vt");
    app.add_option_function(
           "--weld",
           [&o](double d)
           {
               o.weld = d;
               o.repair = true;
           },
           "Repair, and weld corners at open edges at most D apart, in units of the file; "
           "0: only equal ones. --repair alone welds within 1e-7 of the size, or 8 units "
           "of the last digit of the file")
        .type_name("D")
        .check(number_that([](double x) { return x >= 0 && std::isfinite(x); }, "must be a length, 0 or more"));
    const auto distortion = number_that([](double x) { return x > 4 && std::isfinite(x); }, "is not above 4");
    app.add_option("--max-distortion", o.max_distortion,
                   "Bound of the mean isometric energy of a chart; 4 is no distortion; default none, 4.2 for packing")
        .type_name("D")
        .check(distortion);
    app.add_option("--mean-distortion", o.mean_distortion,
                   "Bound of the mean isometric energy of all charts; default 4.1, 4.045 for packing, or "
                   "--max-distortion if given")
        .type_name("D")
        .check(distortion);
    app.add_option("--max-stretch", o.max_stretch,
                   "The bound as stretch (L2, Sander et al. 2001) of the whole atlas, above 1; "
                   "1.02: texels are on average 2 % too coarse")
        .type_name("S")
        .check(number_that([](double x) { return x > 1 && std::isfinite(x); }, "is not above 1, that of no stretch"));
    add_choice<chart_preference>(
        app, "--prefer", o.prefer,
        {{"seams", chart_preference::seams}, {"packing", chart_preference::packing}, {"one", chart_preference::one}},
        "Few charts along short seams, charts that fill the square better, or one per component");
    add_choice<chart_use>(app, "--charts", o.charts,
                          {{"auto", chart_use::make}, {"keep", chart_use::keep}, {"pack", chart_use::pack}},
                          "Make charts, keep and relax those of the file's vt, or pack those unchanged");
    app.add_flag("--keep-seams", o.keep_seams, "Keep the seams of the file's vt and between its materials");
    app.add_flag("--symmetric", o.symmetric,
                 "Make charts that are mirror images of each other in the plane of symmetry, "
                 "which is detected; no chart crosses it");
    add_input(app, "--seams", o.seams, "the file of seams",
              "Edges that are seams of charts, one per line: two vertices, from 0");
    add_input(app, "--seam-weights", o.seam_weights, "the file of weights of seams",
              "Weights of seams, one per line: a vertex, from 0, and a factor, or the two vertices of an edge and a "
              "factor, from 0.001 to 1000; default 1");
    add_choice<double>(app, "--hide-seams", o.hide, {{"off", 0}, {"mild", 0.5}, {"strong", 1}},
                       "Prefer seams in hollows, where they are hardly visible");
    app.add_option("--crease-angle", o.crease_angle,
                   "Prefer seams along edges bent by more than this, concave ones first, and between materials")
        .type_name("DEGREES")
        .check(number_that([](double x) { return x >= 0 && x <= 180; }, "must be from 0 to 180"));
    add_input(app, "--keep-charts", o.pinned, "the file of faces",
              "Faces, from 0, whose charts of the file's vt keep shape and position; others are packed around them");
    app.rename("--pin", "--keep-charts");
}

void declare_packing(const subcommand& app, atlas_options& o)
{
    app.add_option("--padding", o.padding,
                   "Texels between charts, and from them to the border of the square; default 2, or for --mip-levels")
        .type_name("PX")
        .check(number_that([](double x) { return x >= 0 && std::isfinite(x); }, "must not be negative"));
    app.add_option(
           "--mip-levels", o.mip_levels,
           "Padding that prevents bleeding between charts up to mip level N, but for half a percent between diagonal "
           "neighbours: 3 * 2^N texels; 0 to 10")
        .type_name("N")
        .check_said_range(0, 10);
    app.add_option("--resolution", o.size,
                   "Texels along a side of the square, or of a page wider or higher by a power of two")
        .type_name("N|WxH")
        .capture_default_str();
    app.add_option(
           "--texels-per-unit", o.texels_per_unit,
           "Texels per unit of length of the file, of glTF of its scene, in as many tiles as needed; default as "
           "many as fit")
        .type_name("T")
        .check(number_that([](double x) { return x > 0 && std::isfinite(x); }, "must be positive"));
    add_choice<bool>(app, "--density-in", o.in_scene, {{"world", true}, {"file", false}},
                     "Lengths of glTF as its nodes place the meshes, or as the meshes have them");
    add_choice<bool>(app, "--instances", o.apart, {{"shared", false}, {"apart", true}},
                     "Nodes of glTF that draw one mesh share its place, or have a copy of the mesh and a place each");
    app.add_option("--density", o.densities,
                   "Factor of the texel density of the mesh, node, material, object, group or, of several inputs, file "
                   "of this name; once for each")
        .type_name("NAME=FACTOR")
        .one_value_each()
        .check([](const std::string& text)
               { return density_in(text) ? "" : "must be a name, = and a factor from 0.001 to 1000, such as face=2"; });
    app.add_option("--max-resolution", o.max_resolution,
                   "With --texels-per-unit: double the resolution up to N until the charts fit into one tile, or those "
                   "of --udim")
        .type_name("N")
        .check_said_range(1, 65536);
    app.add_option(
           "--align", o.align,
           "Side of blocks of texels that belong to one chart each: 4 for compressed textures; 1, 2, 4, ..., 64, "
           "at most an eighth of --resolution")
        .type_name("N")
        .check_one_of({1, 2, 4, 8, 16, 32, 64})
        .capture_default_str();
    app.add_option(
           "--udim", o.tiles,
           "Number of tiles: 1001, 1002, ... of UDIM, ten in a row; default 1; 100 at most for --texels-per-unit")
        .type_name("N")
        .check_range(1, 1000);
    add_choice<bool>(app, "--stack", o.stack, {{"none", false}, {"similar", true}},
                     "Stack charts that are rotated and translated copies in space");
    app.add_flag("--tile-per-material", o.by_material, "Give each material its own tile");
    app.add_flag("--no-rotation", o.upright, "Translate charts without rotating them");
    app.rename("--upright", "--no-rotation");
}

void declare_reports(const subcommand& app, atlas_options& o)
{
    add_time_limit(app, o.time_limit, "Stop after S seconds, with the current charts (exit code 8)");
    add_device(app, o.device);
    add_stats(app, o.stats);
    add_output(app, "--picture", o.picture, {.extensions = {".png", ".svg"}}, "Draw the atlas, coloured by distortion");
    add_output(app, "--render", o.render, {.extensions = {".png"}}, "Draw the surface with a checkerboard");
    add_output(app, "--report", o.report, {.extensions = {".html"}},
               "Write a page with model and atlas side by side, for a browser");
    add_progress(app, o.progress, o.quiet);
}

} // namespace

void declare(const subcommand& app, atlas_options& o)
{
    add_input(app, "IN", o.inputs, "the input",
              "Surfaces that share the atlas: OBJ, OFF, PLY, STL, glTF; - is standard input")
        .required()
        .type_name("FILE...");
    add_output(app, "-o,--output", o.outputs,
               {.extensions = {".obj", ".glb", ".gltf"}, .made_of = "IN", .in_place = true},
               "Output, once per surface: the input file with new vt; or one for several: an "
               "OBJ of triangles, one object per surface; - is standard output")
        .required()
        .one_value_each()
        .type_name("OUT.obj|.glb");
    add_format(app, o.format);
    app.add_option("--texcoord-set", o.texcoord_set, "The N of TEXCOORD_N, of glTF")
        .type_name("N")
        .check_range(0, 7)
        .capture_default_str();
    app.add_option("--read-texcoord-set", o.read_texcoord_set,
                   "The set from which charts and seams are read, if different")
        .type_name("N")
        .check_said_range(0, 7);
    declare_charts(app, o);
    declare_packing(app, o);
    declare_reports(app, o);
    app.footer(
        "exit codes: 0 certified and written; 2 usage; 3 unreadable input; 4 unsuitable input: --repair may help;\n"
        "  5 no device; 6 no valid atlas; 8 time limit, written; 9 device failure; 130 interrupted, 143 terminated");
}

namespace
{

/// Width and height of N or WxH; nothing for another text.
std::optional<std::array<int, 2>> page_of(std::string_view text)
{
    const auto whole = [](std::string_view digits)
    {
        int n = 0;
        const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
        return fault == std::errc() && end == digits.data() + digits.size() && n <= 65536 ? n : 0;
    };
    const auto cross = text.find('x');
    const int width = whole(text.substr(0, cross)), height = cross == text.npos ? width : whole(text.substr(cross + 1));
    if (width < 1 || height < 1) return {};
    return std::array{width, height};
}

/// Throws usage_error for pages that are none.
void check_pages(const atlas_options& o)
{
    const auto page = page_of(o.size);
    if (!page) throw usage_error("--resolution " + o.size + ": must be N or WIDTHxHEIGHT, from 1 to 65536");
    const auto [width, height] = *page;
    const double aspect = static_cast<double>(height) / width, power = std::exp2(std::round(std::log2(aspect)));
    if (aspect != power || aspect < 1.0 / 16 || aspect > 16)
        throw usage_error("--resolution " + o.size +
                          ": the ratio of the sides must be a power of two, at most 16, such "
                          "as 2048x1024");
    if (aspect != 1 && !o.pinned.empty())
        throw usage_error("--resolution " + o.size + ": charts of --keep-charts lie in squares; give one number");
    const double padding = padding_of(o);
    if (2 * padding >= std::min(width, height))
        throw usage_error((o.mip_levels ? "--mip-levels: padding " : "--padding ") + number(padding, 6) +
                          ": must be less than half of --resolution, " + std::to_string(std::min(width, height)));
    if (8 * o.align > std::min(width, height))
        throw usage_error("--align " + std::to_string(o.align) + ": must be an eighth of --resolution at most");
    if (o.padding && o.mip_levels) throw usage_error("--padding and --mip-levels: give one of them");
    if (o.max_resolution > 0 && !(o.texels_per_unit > 0))
        throw usage_error("--max-resolution is for --texels-per-unit; give both");
    if (o.max_resolution > 0 && o.max_resolution < width)
        throw usage_error("--max-resolution " + std::to_string(o.max_resolution) + ": is below --resolution, " +
                          std::to_string(width));
    if (o.stack && !o.pinned.empty())
        throw usage_error("--stack moves charts, and --keep-charts keeps them; leave out one of them");
    if (o.by_material && o.tiles)
        throw usage_error("--tile-per-material has as many tiles as materials; leave out --udim");
    if (o.by_material && !o.pinned.empty())
        throw usage_error("--tile-per-material: the charts of --keep-charts have their tiles; leave out one of them");
    if (o.by_material && o.inputs.size() > 1)
        throw usage_error("--tile-per-material is for one surface; map the surfaces one at a time");
}

} // namespace

double padding_of(const atlas_options& o)
{
    return o.mip_levels ? 3 * std::exp2(*o.mip_levels) : o.padding.value_or(pack_params{}.padding);
}

void check(const atlas_options& o)
{
    if (o.outputs.size() != 1 && o.inputs.size() != o.outputs.size())
        throw usage_error(std::to_string(o.inputs.size()) + " surfaces and " + std::to_string(o.outputs.size()) +
                          " outputs: give -o once for each surface, in their order, or one for all");
    if (!(o.time_limit > 0)) throw usage_error("--time-limit: must be positive");
    if (o.inputs.size() > 1 && !o.seams.empty())
        throw usage_error("--seams names vertices of one surface; map the surfaces one at a time, or use --keep-seams");
    if (!o.seam_weights.empty() && (o.inputs.size() > 1 || o.symmetric || !o.pinned.empty()))
        throw usage_error(
            "--seam-weights names vertices of one whole surface; leave out --symmetric and --keep-charts, and map "
            "surfaces one at a time");
    if (o.inputs.size() > 1 && !o.pinned.empty())
        throw usage_error("--keep-charts names faces of one surface; map the surfaces one at a time");
    const bool gltf = std::any_of(o.inputs.begin(), o.inputs.end(), io::is_gltf);
    const bool others = !std::all_of(o.inputs.begin(), o.inputs.end(), io::is_gltf);
    std::set<std::string> named;
    for (const auto& density : o.densities)
        if (const auto name = density_in(density)->name; !named.insert(name).second)
            throw usage_error("--density " + name + ": is given twice; give one factor");
    if (o.apart && !gltf) throw usage_error("--instances needs glTF input, which has nodes; leave it out");
    if (o.apart && o.stack)
        throw usage_error("--stack lays copies on each other, and --instances lays them apart; leave out one of them");
    if (!o.in_scene && !gltf) throw usage_error("--density-in needs glTF input, which has a scene; leave it out");
    if (o.texcoord_set > 0 && !gltf) throw usage_error("--texcoord-set needs glTF input; leave it out");
    if (o.read_texcoord_set && !gltf) throw usage_error("--read-texcoord-set needs glTF input; leave it out");
    if (o.read_texcoord_set && !o.keep_charts() && !o.keep_seams && o.pinned.empty())
        throw usage_error(
            "--read-texcoord-set: nothing is read; give --charts, --keep-seams or --keep-charts, or leave it out");
    if (o.format != io::surface_format::automatic && !others)
        throw usage_error("--format is for OBJ, OFF, PLY and STL; leave it out for glTF");
    if (o.symmetric && (o.keep_charts() || !o.pinned.empty()))
        throw usage_error("--symmetric makes charts; leave out --charts keep and --keep-charts");
    if (o.symmetric && o.stack)
        throw usage_error("--stack similar lays copies on each other, and mirror images are no copies; leave out "
                          "--symmetric, or --stack");
    if (o.max_stretch && (o.max_distortion || o.mean_distortion))
        throw usage_error("--max-stretch bounds the mean distortion; leave out --max-distortion and "
                          "--mean-distortion");
    if (o.keep_charts())
    {
        const std::string given = o.charts == chart_use::pack ? "--charts pack" : "--charts keep";
        if (o.hide > 0 || o.crease_angle < 180 || !o.seam_weights.empty())
            throw usage_error(given + " keeps the seams of the vt; leave out --hide-seams, --crease-angle and "
                                      "--seam-weights");
        if (o.keep_seams) throw usage_error(given + " keeps only the seams of the vt; leave out --keep-seams");
        if (o.prefer != chart_preference::seams) throw usage_error(given + " makes no charts; leave out --prefer");
        if (o.max_distortion || o.mean_distortion || o.max_stretch)
            throw usage_error(given + " cuts no chart, so there is no bound; leave out --max-distortion, "
                                      "--mean-distortion and --max-stretch");
    }
    check_pages(o);
    const bool joined = o.outputs.size() < o.inputs.size();
    if (joined && o.apart)
        throw usage_error(
            "--instances apart: one file of several surfaces has no nodes; give -o once for each surface");
    if (joined && io::is_gltf(o.outputs[0]))
        throw usage_error("-o " + o.outputs[0] +
                          ": several surfaces become one file as .obj; for glTF give -o once "
                          "for each surface");
    if (!joined)
        for (std::size_t i = 0; i < o.inputs.size(); ++i)
            if (io::is_gltf(o.inputs[i]) && !io::is_gltf(o.outputs[i]))
                throw usage_error("-o " + o.outputs[i] + ": a model of glTF is written as .glb or .gltf; name it so");
}

std::string as_command_line(const atlas_options& o)
{
    std::string line = "taut atlas";
    const auto word = [&](const std::string& text)
    {
        const bool plain =
            !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                    "0123456789_-+=./,:%@") == text.npos;
        line += ' ';
        if (plain)
        {
            line += text;
            return;
        }
        line += '\'';
        for (const char c : text) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    };
    const auto option = [&](const char* name, const std::string& value)
    {
        if (value.empty()) return;
        word(name);
        word(value);
    };
    const auto flag = [&](const char* name, bool given)
    {
        if (given) word(name);
    };
    for (const auto& input : o.inputs) word(input);
    for (const auto& output : o.outputs) option("-o", output);
    flag("--repair", o.repair);
    if (o.weld) option("--weld", number(*o.weld, 17));
    if (o.max_distortion) option("--max-distortion", number(*o.max_distortion, 9));
    if (o.mean_distortion) option("--mean-distortion", number(*o.mean_distortion, 9));
    if (o.max_stretch) option("--max-stretch", number(*o.max_stretch, 9));
    if (o.prefer == chart_preference::packing) option("--prefer", "packing");
    if (o.prefer == chart_preference::one) option("--prefer", "one");
    if (o.charts == chart_use::keep) option("--charts", "keep");
    if (o.charts == chart_use::pack) option("--charts", "pack");
    flag("--keep-seams", o.keep_seams);
    flag("--symmetric", o.symmetric);
    option("--seams", o.seams);
    option("--seam-weights", o.seam_weights);
    if (o.hide > 0) option("--hide-seams", o.hide < 1 ? "mild" : "strong");
    if (o.crease_angle < 180) option("--crease-angle", number(o.crease_angle, 9));
    option("--keep-charts", o.pinned);
    if (o.mip_levels)
        option("--mip-levels", std::to_string(*o.mip_levels));
    else
        option("--padding", number(padding_of(o), 9));
    option("--resolution", o.size);
    if (o.texels_per_unit > 0) option("--texels-per-unit", number(o.texels_per_unit, 9));
    if (o.apart) option("--instances", "apart");
    if (!o.in_scene) option("--density-in", "file");
    for (const auto& density : o.densities) option("--density", density);
    if (o.max_resolution > 0) option("--max-resolution", std::to_string(o.max_resolution));
    if (o.align > 1) option("--align", std::to_string(o.align));
    if (o.tiles) option("--udim", std::to_string(*o.tiles));
    if (o.stack) option("--stack", "similar");
    flag("--tile-per-material", o.by_material);
    flag("--no-rotation", o.upright);
    if (o.texcoord_set > 0) option("--texcoord-set", std::to_string(o.texcoord_set));
    if (o.read_texcoord_set) option("--read-texcoord-set", std::to_string(*o.read_texcoord_set));
    return line;
}

vec2 origin_of(const atlas_options& o)
{
    return {0, std::any_of(o.outputs.begin(), o.outputs.end(), io::is_gltf) ? -1 : 0};
}

source_options to_source_options(const atlas_options& o)
{
    return {.format = o.format,
            .repair = o.repair,
            .weld = o.weld,
            .texcoord_set = o.texcoord_set,
            .read_texcoord_set = o.read_texcoord_set.value_or(o.texcoord_set),
            .origin = origin_of(o),
            .apart = o.apart,
            .in_scene = o.in_scene};
}

atlas_params to_params(const atlas_options& o)
{
    atlas_params params;
    params.prefer = o.prefer;
    if (o.prefer == chart_preference::packing)
    {
        params.charts.max_distortion = segment_params{}.max_distortion;
        params.charts.mean_distortion = segment_params{}.mean_distortion;
    }
    if (o.max_distortion) params.charts.mean_distortion = params.charts.max_distortion = *o.max_distortion;
    if (o.mean_distortion) params.charts.mean_distortion = *o.mean_distortion;
    // At the scale that keeps the area the mean of s1^2 + s2^2 is 2 at least, so that of 1/s1^2 + 1/s2^2, twice the
    // square of the stretch, is E - 2 at most.
    if (o.max_stretch) params.charts.mean_distortion = 2 + 2 * *o.max_stretch * *o.max_stretch;
    params.charts.max_distortion = std::max(params.charts.max_distortion, params.charts.mean_distortion);
    if (o.keep_charts()) params.prefer = o.charts == chart_use::pack ? chart_preference::laid : chart_preference::kept;
    params.hide_seams = o.hide;
    params.crease_angle = o.crease_angle;
    params.stack = o.stack;
    params.symmetric = o.symmetric;
    const auto [width, height] = *page_of(o.size);
    params.packing.padding = padding_of(o);
    params.packing.resolution = width;
    params.packing.aspect = static_cast<double>(height) / width;
    params.packing.texels_per_unit = o.texels_per_unit;
    params.packing.max_resolution = o.max_resolution;
    params.packing.align = o.align;
    params.packing.tiles = o.tiles.value_or(o.texels_per_unit > 0 && o.max_resolution == 0 ? 100 : 1);
    params.packing.rotate = !o.upright;
    params.origin = origin_of(o);
    return params;
}

} // namespace taut::tools
