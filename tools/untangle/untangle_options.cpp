// SPDX-License-Identifier: MIT
#include "untangle/untangle_options.hpp"

#include "shared/choices.hpp"
#include "shared/failure.hpp"
#include "shared/shared_options.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

namespace
{

/// Throws usage_error where there is an option that problems have no use for.
void require_problem_options(const untangle_options& o)
{
    const auto refuse = [](const char* option, bool given)
    {
        if (given) throw usage_error(std::string(option) + " is for volume files; a problem contains it, leave it out");
    };
    refuse("--rest", !o.rest.empty());
    refuse("--zone", o.zone > 0);
    refuse("--pins", !o.pins.empty());
    refuse("--fix", !o.fixed.empty());
    refuse("--boundary", o.boundary != untangle_boundary::automatic);
}

} // namespace

void declare(const subcommand& app, untangle_options& o)
{
    add_input(
        app, "PROBLEM", o.input, "the input",
        "Problem (rest shape, initial map, cells and fixed vertices, as text), - is standard input; or a volume, or "
        "a mesh of the plane, with inverted elements: .mesh .msh .vtk .vtu .node .su2")
        .required();
    add_output(app, "-o,--output", o.output, {.made_of = "PROBLEM", .may_fail = true},
               "Output: for a problem the map, one vertex per line, - is standard output; for a "
               "volume the same file with new coordinates. OUT.invalid if it is not injective")
        .required()
        .type_name("OUT");
    add_input(app, "--rest", o.rest, "the shape at rest",
              "The volume at rest, with the same vertices and cells; default: regular elements "
              "as target shapes");
    add_input(app, "--pins", o.pins, "the file of pins",
              "Pins of vertices of the volume: vertex,x,y,z, vertices from 0")
        .type_name("FILE.csv");
    add_fix(app, o.fixed);
    add_zone(app, o.zone);
    add_choice<untangle_boundary>(app, "--boundary", o.boundary,
                                  {{"auto", untangle_boundary::automatic},
                                   {"fixed", untangle_boundary::fixed},
                                   {"free", untangle_boundary::free}},
                                  "Fix the boundary of the volume, or not; auto: fixed unless there are --pins or "
                                  "--fix");
    add_refine(app, o.refine, o.refined_map,
               "Split elements if it is proved that the mesh admits no injective map, or none "
               "was found; the output then has more vertices, the original ones first. OUT of a "
               "problem is then a problem");
    add_time_limit(app, o.time_limit, "Give up after S seconds");
    add_device(app, o.device);
    add_stats(app, o.stats);
    add_drawing(app, o.picture, o.clip, "Draw the map before and after, with its pins");
    add_progress(app, o.progress, o.quiet);
    app.footer("exit codes: 0 injective map; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
               "  6 not found, the best map is in OUT.invalid; 7 proved infeasible; 9 device failure; 130 interrupted, "
               "143 terminated");
}

void check(const untangle_options& o)
{
    const bool volume = names_volume(o.input);
    if (!volume) require_problem_options(o);
    if (volume) require_file(o.output);
}

} // namespace taut::tools
