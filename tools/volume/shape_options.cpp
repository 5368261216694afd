// SPDX-License-Identifier: MIT
#include "volume/shape_options.hpp"

#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>

#include "shared/choices.hpp"
#include "shared/outputs.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "volume/group_targets.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

namespace
{

/// Options that both commands have. usual: the tolerance without an option
void declare_shared(const subcommand& app, shape_options& o, const std::string& usual)
{
    add_input(app, "MESH", o.input, "the input",
              std::string("Tetrahedra, or triangles of the plane: .mesh .msh .vtk .vtu .node .su2 .prob") +
                  (o.smoothing ? "" : "; or a surface in space: .obj .off .ply .stl"))
        .required();
    add_output(app, "-o,--output", o.output, {.made_of = "MESH"},
               "Mesh to write, in the format of the input: the same file with other coordinates" +
                   std::string(o.smoothing ? "" : "; of a surface in space .obj, - is standard output"))
        .required()
        .type_name("OUT");
    add_fix(app, o.fixed);
    add_zone(app, o.zone);
    app.add_option("--tolerance", o.tolerance,
                   "Stop at this relative gradient, below 1, or at a negligible Newton decrement; "
                   "0: never. Default: " +
                       usual)
        .type_name("T")
        .check(number_that([](double x) { return x >= 0 && x < 1; }, "must be at least 0 and below 1"));
    add_time_limit(app, o.time_limit, "Stop after S seconds, with the best mesh so far");
    add_device(app, o.device);
    add_stats(app, o.stats);
    add_drawing(app, o.picture, o.clip, "Draw the mesh before and after");
    add_progress(app, o.progress, o.quiet);
    app.footer("exit codes: 0 valid mesh; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
               "  6 none was found; 7 proved infeasible; 8 time limit, with the best mesh written; 9 device failure;\n"
               "  130 interrupted, 143 terminated");
}

} // namespace

void declare_deform(const subcommand& app, shape_options& o)
{
    declare_shared(app, o, "1e-6");
    add_input(app, "--pins", o.pins, "the file of pins", "Pins and springs: vertex,x,y,z[,weight], vertices from 0")
        .type_name("FILE.csv");
    const option moves =
        app.add_option(
               "--move", o.moves,
               "Move a group: GROUP=FILE.csv (vertex,x,y,z), GROUP:translate:x,y,z, GROUP:rotate:ax,ay,az,degrees "
               "or GROUP:scale:factor, about its centre")
            .type_name("MOVE");
    declare_files(app, moves, {.read_as = "the file of --move", .file_in = file_of_move});
    add_input(app, "--rest", o.rest, "the shape at rest",
              "The mesh at rest, if the input is not: the same vertices and cells");
    add_choice<shape_energy>(app, "--energy", o.energy,
                             {{"isometric", shape_energy::isometric},
                              {"shape", shape_energy::shape},
                              {"volume", shape_energy::volume},
                              {"neo-hookean", shape_energy::neo_hookean}},
                             "Energy: preserves lengths, angles, volumes, or models rubber");
    add_refine(app, o.refine, o.refined_map,
               "Split elements if it is proved that the mesh admits no valid shape; the output "
               "then has more vertices, the original ones first");
    app.add_option("--thickness", o.thickness,
                   "Thickness of a surface in space (.obj .off .ply .stl), in its units: thick "
                   "surfaces arch, thin ones crease. Default: the mean edge")
        .type_name("H")
        .check(number_that([](double x) { return x > 0; }, "must be positive"));
}

void declare_smooth(const subcommand& app, shape_options& o)
{
    o.smoothing = true;
    declare_shared(app, o, "1e-4");
    add_choice<smooth_boundary>(
        app, "--boundary", o.boundary,
        {{"sliding", smooth_boundary::sliding}, {"fixed", smooth_boundary::fixed}, {"free", smooth_boundary::free}},
        "Treatment of the boundary");
    add_choice<bool>(app, "--interfaces", o.free_interfaces, {{"kept", false}, {"free", true}},
                     "Treatment of inner faces between regions or with a label: kept faces slide "
                     "within flat parts, like the boundary");
    app.add_option("--exponent", o.worst_exponent, "Exponent of the energy: 1 improves the mean, more the worst elements")
        .type_name("1..8")
        .check_range(1, 8);
    app.rename("--worst", "--exponent");
}

bool names_surface(const std::string& path)
{
    const auto kind = extension(path);
    return kind == ".obj" || kind == ".off" || kind == ".ply" || kind == ".stl";
}

void check(const shape_options& o)
{
    if (o.smoothing || !names_surface(o.input)) require_file(o.output);
}

std::string kept_interfaces_note(std::uint64_t vertices)
{
    return count(vertices, "vertex inside stays on an interface", "vertices inside stay on interfaces") +
           " between regions, or on labelled faces; --interfaces free releases them";
}

any_energy energy_of(shape_energy choice)
{
    switch (choice)
    {
    case shape_energy::shape:
        return energy::shape{};
    case shape_energy::volume:
        return 0.5 * energy::area{} + 0.5 * energy::isometric{};
    case shape_energy::neo_hookean:
        return energy::neo_hookean{};
    case shape_energy::isometric:
        break;
    }
    return energy::isometric{};
}

} // namespace taut::tools
