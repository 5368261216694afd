// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/certify.hpp>
#include <taut/impl/charts/repair/repair_finding.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/files/surface/surface_file_bodies.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>
#include <taut/untangle.hpp>
#include <taut/volume_file.hpp>

#include "check/check_report.hpp"
#include "commands.hpp"
#include "shared/choices.hpp"
#include "shared/other_way.hpp"
#include "shared/outputs.hpp"
#include "shared/repair_report.hpp"
#include "shared/report_files.hpp"
#include "shared/seams.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"
#include "volume/check_volume.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

namespace
{

/// Adds pins one by one, so that each fault is found. cut: of a surface that is cut open.
template <class Element>
void add_constraints(check_report& report, const std::vector<io::pin<Element::dimension>>& read,
                     constraints<Element>& pins, const std::optional<io::cut_surface>& cut = {})
{
    const auto divided = cut ? divided_vertices(*cut) : std::vector<idx>();
    for (const auto& pin : read) try
        {
            if constexpr (Element::dimension == 2) require_undivided({&pin, 1}, divided);
            pins.add(std::vector{pin});
        }
        catch (const constraint_error& e)
        {
            report_pins<Element>(report, e, &pin);
        }
        catch (const unsuitable_input& e)
        {
            report.add({true, "pins", "seam", {pin.vertex}, e.what()}, exit_code::unsuitable_input);
        }
}

/// The cut that `taut unwrap` makes. One that leaves no disk is a finding.
std::optional<io::cut_surface> find_cut(check_report& report, const io::surface_file& file)
{
    try
    {
        auto cut = cut_open(file, {}, false);
        if (cut) report.add({false, "file", "note", {}, describe(*cut)}, exit_code::valid);
        return cut;
    }
    catch (const unsuitable_input& e)
    {
        report.add({true, "mesh", "seams", {}, e.what()}, exit_code::unsuitable_input);
        return std::nullopt;
    }
}

/// Pins may be too far away for the size of a mesh.
template <class Element>
bool near_enough(check_report& report, const mesh<Element>& m, const constraints<Element>& pins)
{
    try
    {
        pins.require_near(impl::unit_scale(m));
        return true;
    }
    catch (const constraint_error& e)
    {
        report_pins<Element>(report, e);
        return false;
    }
}

/// Pins of vertices that no triangle uses hold nothing. Those of volumes and problems stay where they are pinned.
template <class Element>
bool all_used(check_report& report, const mesh<Element>& m, const constraints<Element>& pins)
{
    if (report.kind != "surface") return true;
    try
    {
        pins.require_used(impl::unused_vertices(m.points().size(), m.cells()));
        return true;
    }
    catch (const constraint_error& e)
    {
        report_pins<Element>(report, e);
        return false;
    }
}

template <class Element>
void judge(check_report& report, const mesh<Element>& m, std::vector<vec<Element::dimension>> initial,
           const constraints<Element>& pins, std::vector<idx> owners = {})
{
    report.pins = pins.pins().size();
    report.springs = pins.springs().size();
    if (!near_enough(report, m, pins) || pins.pins().empty()) return;
    if (!all_used(report, m, pins)) return;
    auto problem = make_untangle_problem(m, std::move(initial), pins);
    problem.owners = std::move(owners);
    const auto found = find_infeasibility(problem);
    for (const auto& f : found.proofs)
        report.add({true, "feasibility", to_string(f.kind), f.ids, f.message}, exit_code::infeasible);
    for (const auto& f : found.warnings)
        report.add({false, "feasibility", to_string(f.kind), f.ids, f.message}, exit_code::valid);
}

/// Repairs of --repair.
std::vector<repair_finding> find_repairs(const io::surface_soup& soup)
{
    try
    {
        return repair(soup).findings;
    }
    catch (const repair_error& e)
    {
        return e.findings();
    }
    catch (const mesh_error&) // there is nothing to mend
    {
        return {};
    }
}

/// Adds what is known from mending alone. A mesh that can be used is no worse for it.
void report_repairs(check_report& report, const std::vector<repair_finding>& repairs, bool usable)
{
    for (const auto& r : repairs)
    {
        const auto known = [&](const finding& f) { return f.fault == to_string(r.kind); };
        if (std::none_of(report.findings.begin(), report.findings.end(), known))
            report.add({!usable && impl::is_fault(r.kind), "mesh", to_string(r.kind), r.ids, r.problem, r.action},
                       exit_code::unsuitable_input);
    }
}

/// The surface of a file. One that cannot be made is a finding, with its place in the file and all others of its kind.
std::optional<io::surface_file> find_surface(check_report& report, const std::string& path, io::surface_soup soup,
                                             const std::vector<repair_finding>& repairs)
{
    try
    {
        return io::impl::to_surface_file(std::move(soup), path);
    }
    catch (const mesh_error& e)
    {
        mesh_finding found{e.fault(), e.ids(), e.what()};
        std::string action;
        for (const auto& r : repairs)
        {
            if (std::string_view(to_string(r.kind)) != to_string(e.fault())) continue;
            action = r.action;
            if (r.ids.size() == 1) continue;
            found.ids = r.ids;
            found.message += "; in all " + r.problem;
        }
        report_mesh(report, found, true, action);
        return std::nullopt;
    }
}

void check_surface(check_report& report, const check_options& options)
{
    report.kind = "surface";
    auto soup = io::read_surface_soup(options.input, *options.format);
    report.vertices = soup.points.size();
    report.cells = soup.triangles.size();
    for (const auto& note : soup.notes) report.add({false, "file", "note", {}, note}, exit_code::valid);
    const auto repairs = find_repairs(soup);
    const auto unused = impl::unused_vertices(soup.points.size(), soup.triangles);
    const auto file = find_surface(report, options.input, std::move(soup), repairs);
    if (!file) return report_repairs(report, repairs, false);
    if (!unused.empty())
        report.add({false, "mesh", to_string(mesh_error::unreferenced_vertex), unused, impl::describe_unused(unused)},
                   exit_code::valid);
    const auto cut = find_cut(report, *file);
    const auto& m = cut ? cut->surface : file->surface;
    for (const auto& f : taut::check(m, {.referenced = false}))
    {
        const auto mends = [&](const repair_finding& r)
        { return std::string_view(to_string(r.kind)) == to_string(f.fault); };
        const auto at = std::find_if(repairs.begin(), repairs.end(), mends);
        report_mesh(report, f, true, at == repairs.end() ? std::string() : at->action);
    }
    report_repairs(report, repairs, true);
    auto pins = taut::constraints(m);
    if (!options.pins.empty())
        add_constraints(report, io::read_pins<2>(options.pins, file->surface.vertex_count()), pins, cut);
    judge(report, m, std::vector<vec2>(m.points().size(), vec2(0.0)), pins);
}

template <class Element>
void check_problem(check_report& report, const check_options& options, io::impl::prob_file<Element> file)
{
    constexpr int D = Element::dimension;
    report.kind = std::string("problem of ") + Element::names;
    report.cells_name = Element::names;
    auto fixed = std::move(file.fixed);
    std::sort(fixed.begin(), fixed.end());
    fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
    auto problem = make_untangle_problem(std::move(file));
    report.vertices = problem.rest.points().size();
    report.cells = problem.rest.cells().size();
    report.has_map = true;
    report.map = certify<D>(problem.rest.cells(), std::span<const vec<D>>(problem.initial));
    // What touches at a vertex alone, and vertices without cells, are no obstacle to untangling.
    const mesh_requirements need{.connected = false, .open = false, .one_boundary = false, .no_handles = false};
    for (const auto& f : taut::check(problem.rest, need))
        report_mesh(report, f,
                    f.fault != mesh_error::unreferenced_vertex && f.fault != mesh_error::non_manifold_vertex);
    auto pins = taut::constraints(problem.rest);
    pins.fix(fixed, problem.initial);
    if (!options.pins.empty())
        add_constraints(report, io::read_pins<D>(options.pins, problem.rest.vertex_count()), pins);
    judge(report, problem.rest, problem.initial, pins);
}

void check_volume(check_report& report, const check_options& options)
{
    const auto file = io::read_volume_file(options.input, io::volume_format::automatic, options.zone);
    report_contents(report, file);
    with_case(file,
              [&]<class Element>(const volume_case<Element>& input)
              {
                  report_cells(report, input);
                  const auto& m = input.simplices();
                  auto pins = taut::constraints(m);
                  if (!options.pins.empty()) add_constraints(report, input.read_pins(options.pins), pins);
                  judge(report, m, input.points(), pins, input.owners());
              });
}

/// Looks at the files; what cannot be read is a finding, too.
check_report examine(const check_options& options)
{
    check_report report;
    try
    {
        const bool by_name = options.format == io::surface_format::automatic;
        const bool volume = by_name && names_volume(options.input);
        if (options.zone > 0 && !volume) throw usage_error("--zone is for SU2 files; leave it out");
        if (volume)
            check_volume(report, options);
        else if (!options.format || (by_name && extension(options.input) == ".prob"))
            std::visit([&](auto&& file) { check_problem(report, options, std::move(file)); },
                       io::read_prob(options.input));
        else
            check_surface(report, options);
    }
    catch (const io::io_error& e)
    {
        const auto other = other_way(e, "check");
        report.add({true, "file", "unreadable", {}, e.what() + (other.empty() ? other : "; " + other)},
                   exit_code::unreadable_input);
    }
    catch (const mesh_error& e)
    {
        report_mesh(report, {e.fault(), e.ids(), e.what()}, true);
    }
    return report;
}

nlohmann::ordered_json json_of(const check_report& r, const check_options& options)
{
    nlohmann::ordered_json json;
    json["schema"] = "taut.check/1";
    json["input"] = options.input;
    json["pins_file"] = options.pins.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(options.pins);
    json["kind"] = r.kind;
    json["vertices"] = r.vertices;
    json["cells"] = r.cells;
    json["pins"] = r.pins;
    json["springs"] = r.springs;
    json["inverted"] = r.has_map ? nlohmann::ordered_json(r.map.flipped) : nlohmann::ordered_json(nullptr);
    json["branch_points"] = r.has_map ? nlohmann::ordered_json(r.map.branched) : nlohmann::ordered_json(nullptr);
    json.update(r.details);
    json["exit_code"] = to_int(r.code);
    json["findings"] = nlohmann::ordered_json::array();
    for (const auto& f : r.findings)
        json["findings"].push_back(
            {{"severity", f.wrong ? "error" : "warning"},
             {"about", f.about},
             {"fault", f.fault},
             {"ids", f.ids},
             {"message", f.message},
             {"repair", f.repair.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(f.repair)}});
    return json;
}

std::string lines_of(const check_report& r, const check_options& options)
{
    labelled_lines lines;
    const std::string singular = r.cells_name == triangle::names ? triangle::name : tetrahedron::name;
    if (r.vertices > 0)
        lines.add("input", options.input + ": " + r.kind + ", " + count(r.vertices, "vertex", "vertices") + ", " +
                               (r.lines.empty() ? count(r.cells, singular, r.cells_name) : r.cells_name));
    for (const auto& [label, text] : r.lines) lines.add(label, text);
    if (r.has_map && r.lines.empty())
        lines.add("map", count(r.map.flipped) + " of " + count(r.cells) + " inverted at the start" +
                             (r.map.branched > 0 ? ", " + count(r.map.branched, "branch point", "branch points") : ""));
    if (r.pins + r.springs > 0)
        lines.add("pins", count(r.pins, "pinned vertex", "pinned vertices") +
                              (r.springs > 0 ? ", " + count(r.springs, "spring", "springs") : ""));
    std::size_t wrong = 0;
    for (const auto& f : r.findings)
    {
        lines.add(f.wrong ? "error" : "warning",
                  f.message + (f.repair.empty() ? "" : "; taut atlas --repair: " + f.repair));
        wrong += f.wrong ? 1 : 0;
    }
    lines.add("result", wrong == 0 ? "nothing wrong" : count(wrong, "error", "errors") + ": " + describe(r.code));
    return (std::ostringstream() << lines).str();
}

exit_code run(const check_options& options)
{
    const auto report = examine(options);
    write_standard_output(options.json ? text_of(json_of(report, options)) : lines_of(report, options));
    return report.code;
}

} // namespace

command add_check(command_line& program)
{
    const auto options = std::make_shared<check_options>();
    const auto app =
        program.add_subcommand("check", "Report the faults of a surface, a volume, a problem or pins, without solving");
    add_input(app, "IN", options->input, "the input",
              "Surface for `unwrap` (OBJ, OFF, PLY, STL), problem (.prob), or volume or planar mesh "
              "(.mesh .msh .vtk .vtu .node .su2); - is standard input")
        .required();
    using io::surface_format;
    add_choice<std::optional<surface_format>>(app, "--format", options->format,
                                              {{"auto", surface_format::automatic},
                                               {"obj", surface_format::obj},
                                               {"off", surface_format::off},
                                               {"ply", surface_format::ply},
                                               {"stl", surface_format::stl},
                                               {"prob", {}}},
                                              "Kind of IN; auto: by its name, for - (standard input) a surface");
    add_input(app, "--pins", options->pins, "the pins",
              "Pins as CSV: vertex,u,v[,weight]; more pins, if IN is a problem")
        .type_name("FILE.csv");
    add_zone(app, options->zone);
    app.add_flag("--json", options->json, "Print JSON");
    app.footer("exit codes: 0 nothing wrong; 2 usage; 3 unreadable input; 4 unsuitable input; 7 proved infeasible");
    return [options](const outputs&) { return run(*options); };
}

} // namespace taut::tools
