// SPDX-License-Identifier: MIT
#include "atlas_options.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "../choices.hpp"
#include "../failure.hpp"
#include "../shared_options.hpp"

namespace taut::tools
{

namespace
{

void declare_charts(CLI::App& app, atlas_options& o)
{
    app.add_flag("--repair", o.repair,
                 "Mend what is no surface: duplicate and flat triangles, edges of three triangles, winding, ...; the "
                 "files keep their vertices and faces, what is left out has no vt");
    const auto distortion = number_that([](double x) { return x > 4 && std::isfinite(x); }, "is not above 4");
    app.add_option("--max-distortion", o.max_distortion,
                   "Bound of the mean isometric energy of a chart; 4 is no distortion, default 4.2")
        ->type_name("D")
        ->check(distortion);
    app.add_option("--mean-distortion", o.mean_distortion,
                   "Bound of that of all charts; default 4.045, or --max-distortion if that is given")
        ->type_name("D")
        ->check(distortion);
    add_choice<bool>(app, "--charts", o.keep_charts, {{"auto", false}, {"keep", true}},
                     "Make charts, or keep those that the vt of the file show and relax them");
    app.add_flag("--keep-seams", o.keep_seams, "The seams of the file's vt and its materials are seams of charts, too");
    app.add_option("--seams", o.seams, "Edges that are seams of charts, a line each: two vertices, from 0")
        ->type_name("FILE");
}

void declare_packing(CLI::App& app, atlas_options& o)
{
    app.add_option("--padding", o.padding, "Texels between charts, and from them to the border of the square")
        ->type_name("PX")
        ->check(number_that([](double x) { return x >= 0 && std::isfinite(x); }, "must not be negative"))
        ->capture_default_str();
    app.add_option("--resolution", o.resolution, "Texels along a side of the square")
        ->type_name("N")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    app.add_option("--udim", o.tiles, "Squares to fill: 1001, 1002, ... of UDIM, ten in a row")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_flag("--upright", o.upright, "Charts are shifted only, not turned");
}

void declare_reports(CLI::App& app, atlas_options& o)
{
    add_time_limit(app, o.time_limit, "Stop after S seconds, with charts as they are (exit code 8)");
    add_device(app, o.device);
    add_path(app, "--stats", o.stats, standard_output, "Write numbers as JSON")->type_name("FILE.json");
    add_path(app, "--picture", o.picture, standard_output, "Draw the atlas, coloured by distortion")
        ->type_name("FILE.png|.svg");
    add_path(app, "--render", o.render, standard_output, "Draw the surface with a checkerboard")->type_name("FILE.png");
    add_progress(app, o.progress, o.quiet);
}

} // namespace

void declare(CLI::App& app, atlas_options& o)
{
    app.add_option("IN", o.inputs, "Surfaces that share the atlas: OBJ, OFF, PLY")->required()->type_name("FILE...");
    app.add_option("-o,--output", o.outputs,
                   "What to write, once for each surface: the file as it is, with new vt; one for several: all of them "
                   "as triangles, an object each")
        ->required()
        ->allow_extra_args(false)
        ->type_name("OUT.obj");
    add_format(app, o.format);
    declare_charts(app, o);
    declare_packing(app, o);
    declare_reports(app, o);
    app.footer(
        "exit codes: 0 certified and written; 2 usage; 3 unreadable input; 4 unsuitable input: --repair may help;\n"
        "  5 no device; 6 no valid atlas; 8 time limit, written; 9 device failure; 130 interrupted, 143 terminated");
}

outputs check(const atlas_options& o)
{
    if (o.outputs.size() != 1 && o.inputs.size() != o.outputs.size())
        throw usage_error(std::to_string(o.inputs.size()) + " surfaces and " + std::to_string(o.outputs.size()) +
                          " outputs: give -o once for each surface, in their order, or one for all");
    if (!(o.time_limit > 0)) throw usage_error("--time-limit: must be positive");
    if (o.inputs.size() > 1 && !o.seams.empty())
        throw usage_error("--seams names vertices of one surface; map the surfaces one at a time, or use --keep-seams");
    outputs files;
    for (const auto& path : o.outputs) files.add("-o", path, {".obj"});
    files.add("--stats", o.stats, {".json"});
    files.add("--picture", o.picture, {".png", ".svg"});
    files.add("--render", o.render, {".png"});
    files.add("--report", o.report, {".html"});
    if (!o.seams.empty()) files.protect("the file of seams", o.seams);
    return files;
}

source_options to_source_options(const atlas_options& o)
{
    return {.format = o.format, .repair = o.repair, .texcoord_set = o.texcoord_set};
}

atlas_params to_params(const atlas_options& o)
{
    atlas_params params;
    if (o.max_distortion) params.charts.mean_distortion = params.charts.max_distortion = *o.max_distortion;
    if (o.mean_distortion) params.charts.mean_distortion = *o.mean_distortion;
    params.charts.max_distortion = std::max(params.charts.max_distortion, params.charts.mean_distortion);
    params.keep_charts = o.keep_charts;
    params.packing.padding = o.padding;
    params.packing.resolution = o.resolution;
    params.packing.tiles = o.tiles;
    params.packing.rotate = !o.upright;
    return params;
}

} // namespace taut::tools
