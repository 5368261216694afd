// SPDX-License-Identifier: MIT
#include "shared/shared_options.hpp"

#include <limits>

#include "shared/choices.hpp"
#include "shared/failure.hpp"

namespace taut::tools
{

void add_format(const subcommand& app, io::surface_format& format)
{
    add_choice<io::surface_format>(app, "--format", format,
                                   {{"auto", io::surface_format::automatic},
                                    {"obj", io::surface_format::obj},
                                    {"off", io::surface_format::off},
                                    {"ply", io::surface_format::ply},
                                    {"stl", io::surface_format::stl}},
                                   "Format of IN; auto: by its name, for - (standard input) by its first bytes");
}

void add_drawing(const subcommand& app, std::string& picture, std::string& clip, const std::string& help)
{
    add_output(app, "--picture", picture, {.extensions = {".png", ".svg"}}, help + ", coloured by distortion");
    app.add_option("--clip", clip,
                   "Show the inside of a volume in the picture: hide elements with the centre beyond a plane across an "
                   "axis, x, y, z or x:FRACTION of the extent, or nx,ny,nz,d: nx x + ny y + nz z = d")
        .type_name("PLANE");
    app.rename("--cut", "--clip");
}

void add_fix(const subcommand& app, std::vector<std::string>& groups)
{
    app.add_option("--fix", groups, "Fix the vertices of a group; may be repeated").type_name("GROUP");
}

void add_zone(const subcommand& app, int& zone)
{
    app.add_option("--zone", zone, "Zone of a SU2 file with several, from 1; the others stay unchanged")
        .type_name("N")
        .check_range(1, std::numeric_limits<int>::max());
}

void add_refine(const subcommand& app, bool& refine, std::string& map, const std::string& help)
{
    app.add_flag("--refine", refine, help);
    add_output(app, "--refined-map", map, {.extensions = {".csv"}},
               "Write the parent in the input of each element, as element,of")
        .needs("--refine");
}

void add_device(const subcommand& app, std::string& device)
{
    app.add_option("--device", device,
                   "Number or part of the name of an OpenCL device, see `taut devices`; default: $TAUT_DEVICE")
        .type_name("D")
        .check([](const std::string& text)
               { return text.empty() ? "there is no device without a name; leave the option out" : ""; });
}

void add_time_limit(const subcommand& app, double& seconds, const std::string& help)
{
    app.add_option("--time-limit", seconds, help)
        .type_name("S")
        .check(number_that([](double x) { return x > 0; }, "must be positive"));
}

void add_progress(const subcommand& app, std::string& progress, bool& quiet)
{
    add_choice<std::string>(app, "--progress", progress, {{"auto", "auto"}, {"json", "json"}, {"none", "none"}},
                            "Progress on standard error: a bar if it is a terminal, one JSON object per "
                            "line, nothing");
    app.add_flag("--quiet", quiet, "Print errors only, and progress if --progress is given");
}

progress_mode progress_of(const std::string& progress, bool quiet)
{
    return quiet && progress == "auto" ? progress_mode::none : *parse_progress_mode(progress);
}

} // namespace taut::tools
