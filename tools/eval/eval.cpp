// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <taut/impl/core/mesh/describe.hpp>
#include <taut/surface_file.hpp>

#include "commands.hpp"
#include "eval/atlas_measures.hpp"
#include "eval/overlapping.hpp"
#include "shared/assessment.hpp"
#include "shared/failure.hpp"
#include "shared/printable.hpp"
#include "shared/report_files.hpp"
#include "shared/reversed_fans.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"
#include "volume/eval_volume.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

namespace
{

struct eval_options
{
    std::string input, map, picture, clip; ///< map and what follows: of volumes
    io::surface_format format{};
    bool json = false;
    int zone = 0; ///< of a SU2 file of several; 0: none
};

/// Takes out the triangles that have no place in the map, as those that --repair leaves out. Returns them.
std::vector<idx> leave_out_unmapped(io::surface_file& file, std::vector<idx>& polygons, std::vector<idx>& kept)
{
    std::vector<idx> gone;
    if (file.texcoord_cells.empty()) return gone;
    for (std::size_t c = 0; c < file.texcoord_cells.size(); ++c)
    {
        const auto& t = file.texcoord_cells[c];
        (std::any_of(t.begin(), t.end(), [](idx x) { return x < 0; }) ? gone : kept).push_back(static_cast<idx>(c));
    }
    if (gone.empty() || kept.empty()) return {};
    const auto of_kept = [&](const auto& all)
    {
        std::decay_t<decltype(all)> some;
        for (const idx c : kept) some.push_back(all[static_cast<std::size_t>(c)]);
        return some;
    };
    if (!polygons.empty()) polygons = of_kept(polygons);
    file.texcoord_cells = of_kept(file.texcoord_cells);
    file.surface = mesh<triangle>(file.surface.points(), of_kept(file.surface.cells()));
    file.faces = {};
    file.faces.sizes.assign(kept.size(), 3);
    for (const auto& t : file.surface.cells()) file.faces.corners.insert(file.faces.corners.end(), t.begin(), t.end());
    return gone;
}

exit_code evaluate(const eval_options& options)
{
    const bool volume = names_volume(options.input) || extension(options.input) == ".prob";
    if (volume && options.format != io::surface_format::automatic)
        throw usage_error("--format is of OBJ, OFF, PLY and STL; leave it out for volumes");
    if (volume)
        return evaluate_volume({options.map.empty() ? options.input : options.map,
                                options.map.empty() ? std::string() : options.input, options.picture, options.clip,
                                options.json, options.zone});
    const auto refuse = [](const char* option, bool given)
    {
        if (given) throw usage_error(std::string(option) + " is for volume files; leave it out");
    };
    refuse("MAP", !options.map.empty());
    refuse("--picture", !options.picture.empty());
    refuse("--clip", !options.clip.empty());
    if (options.zone > 0) throw usage_error("--zone is for SU2 files; leave it out");
    auto file = io::read_surface_file(options.input, options.format);
    if (!file.texcoord_fault.empty())
        throw unsuitable_input(file.texcoord_fault + "; correct it, or let `taut unwrap` make others");
    if (file.texcoords.empty())
        throw unsuitable_input(options.input + ": has no texture coordinates (vt); `taut unwrap` makes them");
    auto polygons = file.faces.of_triangles();
    std::vector<idx> kept;
    const auto gone = leave_out_unmapped(file, polygons, kept);
    const auto cut = file.cut_seams();
    auto a = cut ? assess(cut->surface, cut->uv) : assess(file.surface, file.vertex_texcoords());
    const auto& surface = cut ? cut->surface : file.surface;
    take_polygons(a, impl::find_convex_polygons(surface.cells(), polygons, surface.points()),
                  cut ? cut->uv : file.vertex_texcoords());
    a.reversed_fans = count_reversed_fans(file.faces, surface, cut ? cut->uv : file.vertex_texcoords());
    note_reversed_fans(a.notes, a.reversed_fans);
    auto overlapping = find_overlapping(surface.cells(), cut ? cut->uv : file.vertex_texcoords());
    const std::size_t seam_vertices = cut ? cut->seam_vertices : 0;
    a.vertices = file.surface.vertex_count();
    a.notes.insert(a.notes.begin(), file.notes.begin(), file.notes.end());
    if (!gone.empty())
    {
        a.notes.push_back(taut::impl::list_ids("triangle", "triangles", gone) +
                          " without texture coordinates: left out");
        for (idx& c : a.quality.flips.ids) c = kept[static_cast<std::size_t>(c)];
        for (auto& pair : overlapping.first)
            for (idx& c : pair) c = kept[static_cast<std::size_t>(c)];
    }
    const auto& flips = a.quality.flips;
    const auto measures = measure_atlas(file, cut ? &*cut : nullptr);

    if (options.json)
    {
        nlohmann::ordered_json json;
        json["schema"] = "taut.eval/1";
        json["input"] = options.input;
        json["vertices"] = a.vertices;
        json["faces"] = flips.elements;
        json["left_out"] = gone.size();
        json["seam_vertices"] = seam_vertices;
        json["flipped"] = flips.flipped;
        json["flipped_ids"] = flips.ids;
        json["branch_points"] = flips.branched;
        json["branch_point_ids"] = flips.branch_ids;
        add_polygons(json, a);
        add_overlapping(json, overlapping);
        json["min_det"] = finite(flips.min_det);
        json["max_det"] = finite(flips.max_det);
        json["quality"] = to_json(a);
        json["atlas"] = measures ? to_json(*measures) : nlohmann::ordered_json(nullptr);
        json["notes"] = a.notes;
        write_standard_output(text_of(json));
        return exit_code::valid;
    }
    for (const auto& note : a.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    labelled_lines lines;
    lines.add("mesh", options.input + ": " + count(static_cast<std::size_t>(a.vertices), "vertex", "vertices") + ", " +
                          count(flips.elements, "triangle", "triangles") +
                          (seam_vertices > 0 ? ", " + count(seam_vertices, "vertex", "vertices") + " on seams" : ""));
    describe_validity(lines, a);
    describe(lines, overlapping);
    if (measures) describe(lines, *measures);
    std::ostringstream out;
    out << lines;
    print(out, a);
    write_standard_output(out.str());
    return exit_code::valid;
}

} // namespace

command add_eval(command_line& program)
{
    const auto options = std::make_shared<eval_options>();
    const auto app =
        program.add_subcommand("eval", "Measure the map in a file: energies, flips, crossings, distortion");
    add_input(
        app, "IN", options->input, "the input",
        "OBJ file with texture coordinates, cut open along seams; - is standard input. Or a volume (.mesh .msh .vtk "
        ".vtu .node .su2), or a problem (.prob)")
        .required();
    add_input(app, "MAP", options->map, "the map", "The deformed volume, with the vertices and cells of IN");
    add_format(app, options->format);
    add_drawing(app, options->picture, options->clip, "Draw a volume or a planar mesh");
    add_zone(app, options->zone);
    app.add_flag("--json", options->json, "Print JSON");
    app.footer("exit codes: 0 measured, whatever was found; 2 usage; 3 unreadable input; 4 no texture coordinates");
    return [options](const outputs&) { return evaluate(*options); };
}

} // namespace taut::tools
