// SPDX-License-Identifier: MIT
#include "volume/check_volume.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>

#include "shared/text_table.hpp"
#include "volume/shape_report.hpp"

namespace taut::tools
{

namespace
{

/// "3 cells (5, 9, 12)"
template <class Element>
std::string list_cells(const volume_case<Element>& input, const std::vector<idx>& ids)
{
    const bool mixed = input.parts().overlapping;
    return impl::list_ids(mixed ? "cell" : Element::name, mixed ? "cells" : Element::names, ids);
}

/// The cells of simplices, each once.
std::vector<idx> owners_of(const std::vector<idx>& simplices, const std::vector<idx>& owners)
{
    std::vector<idx> cells;
    for (const idx s : simplices) cells.push_back(owners[static_cast<std::size_t>(s)]);
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

/// Simplices that no deformation can start from, as they are too thin, and others that are nearly flat.
template <class Element>
std::pair<std::vector<idx>, std::vector<idx>> thin_simplices(const mesh<Element>& m)
{
    constexpr double nearly = 1e-12; // height by length: within some thousand roundings
    const double unit = impl::unit_scale(m);
    std::pair<std::vector<idx>, std::vector<idx>> found;
    for (idx s = 0; s < m.cell_count(); ++s)
    {
        if (Element::is_thick(impl::scaled_rest(m, s, unit))) continue;
        const double flatness = Element::flatness(impl::ideal_of(m, s, unit));
        if (!(flatness > nearly)) (flatness > impl::flattest ? found.second : found.first).push_back(s);
    }
    return found;
}

/// Cells that are flat, or turned over, at a corner: by exact signs, however small their measures are.
template <class Element>
void report_signs(check_report& report, const volume_case<Element>& input, const volume_state& state)
{
    const auto x = input.points();
    const auto sign_of = [&](idx simplex)
    {
        return std::apply([&](auto... v) { return impl::orient(x[static_cast<std::size_t>(v)]...).sign; },
                          input.simplices().cells()[static_cast<std::size_t>(simplex)]);
    };
    std::vector<idx> negative, zero;
    for (const idx s : state.simplices.ids) // others are positive
        if (const int sign = sign_of(s); sign <= 0) (sign < 0 ? negative : zero).push_back(s);
    const auto [thin, nearly] = thin_simplices(input.simplices());
    const auto cells_of = [&](const std::vector<idx>& simplices) { return owners_of(simplices, input.parts().cells); };
    const auto without = [](std::vector<idx> cells, const std::vector<idx>& others)
    {
        std::erase_if(cells, [&](idx c) { return std::binary_search(others.begin(), others.end(), c); });
        return cells;
    };
    const auto turned = cells_of(negative), flat = without(cells_of(zero), turned);
    const auto positive = without(without(cells_of(thin), turned), flat);
    const auto nearly_flat = without(without(without(cells_of(nearly), turned), flat), positive);
    std::vector<idx> degenerate;
    for (const auto* cells : {&flat, &positive, &nearly_flat})
        degenerate.insert(degenerate.end(), cells->begin(), cells->end());
    std::sort(degenerate.begin(), degenerate.end());
    report.details["inverted_ids"] = turned;
    report.details["degenerate_ids"] = degenerate;
    if (!turned.empty())
        report_mesh(report,
                    {mesh_error::inverted_cell, turned,
                     list_cells(input, turned) + " inverted, in a mesh that is oriented as " + input.file().format +
                         " files are; `taut untangle` moves vertices"},
                    true);
    const auto report_thin = [&](const std::vector<idx>& cells, bool wrong, const char* what)
    {
        if (!cells.empty())
            report_mesh(report, {mesh_error::degenerate_cell, cells, list_cells(input, cells) + what}, wrong);
    };
    report_thin(flat, true, " flat; collapse an edge or move a vertex of each");
    // As untangling may leave them: certified, and only no shape that a deformation can start from.
    report_thin(positive, false, " positive, but too thin to be a shape at rest; `taut smooth` improves shapes");
    report_thin(nearly_flat, false, " positive, but nearly flat; `taut smooth` improves shapes");
}

/// Reports the faces between cells of one kind.
template <class Element>
void report_facets(check_report& report, const mesh<Element>& m)
{
    const mesh_requirements need{
        .referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false};
    for (const auto& f : taut::check(m, need))
        if (f.fault != mesh_error::degenerate_cell && f.fault != mesh_error::inverted_cell)
            report_mesh(report, f, Element::dimension == 2 || f.fault != mesh_error::non_manifold_vertex);
}

/// Triangles on one side and a quad on the other are no common face: the cells come apart there.
void report_open_quads(check_report& report, const io::impl::cell_faces& sides)
{
    std::vector<std::array<idx, 3>> in_quads, triangles;
    for (std::size_t s = 0; s < sides.faces.size(); ++s)
    {
        if (sides.twin[s] != io::impl::cell_faces::boundary) continue;
        const auto corners = sides.faces[s].corners();
        for (std::size_t k = 0; k < (corners.size() == 4 ? 4 : 1); ++k)
        {
            std::array<idx, 3> t{corners[k], corners[(k + 1) % corners.size()], corners[(k + 2) % corners.size()]};
            std::sort(t.begin(), t.end());
            (corners.size() == 4 ? in_quads : triangles).push_back(t);
        }
    }
    std::sort(in_quads.begin(), in_quads.end());
    std::vector<idx> ids;
    for (const auto& t : triangles)
        if (std::binary_search(in_quads.begin(), in_quads.end(), t)) ids.insert(ids.end(), t.begin(), t.end());
    if (!ids.empty())
        report.add({false, "mesh", "open_quads", ids,
                    impl::list_ids("triangle", "triangles", ids, 3) +
                        " against a quad: both count as boundary; put pyramids between, or split the cell"},
                   exit_code::valid);
}

/// Reports the faces between cells of several kinds.
void report_faces(check_report& report, const io::volume_file& file)
{
    if (file.dimension == 3) report_open_quads(report, file.faces());
    for (const auto& found : io::impl::check_sides(file)) report_mesh(report, found, true);
}

} // namespace

void report_contents(check_report& report, const io::volume_file& file)
{
    report.kind = file.format + (file.dimension == 2 ? ", planar" : ", volume");
    report.vertices = file.points.size();
    report.cells_name = count_cells(file, file.dimension);
    auto notes = file.notes;
    if (!file.turned.empty()) notes.push_back(turned_note(file));
    for (const auto& note : notes) report.add({false, "file", "note", {}, note}, exit_code::valid);
    report.details["turned_ids"] = file.turned;

    report.details["elements"] = nlohmann::ordered_json::object();
    std::vector<char> used(file.points.size(), 0);
    for (const auto& block : file.cells)
    {
        auto& n = report.details["elements"][io::impl::shape_of(block.kind).names];
        n = (n.is_null() ? std::size_t{0} : n.get<std::size_t>()) + block.size();
        if (io::impl::shape_of(block.kind).dimension != file.dimension) continue;
        report.cells += block.size();
        for (const idx v : block.corners) used[static_cast<std::size_t>(v)] = 1;
    }
    std::vector<idx> unused;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (!used[v]) unused.push_back(static_cast<idx>(v));
    if (!unused.empty())
        report.add({false, "mesh", to_string(mesh_error::unreferenced_vertex), unused,
                    impl::list_ids("vertex", "vertices", unused) + " without a cell; they stay where they are"},
                   exit_code::valid);

    std::string names;
    report.details["groups"] = nlohmann::ordered_json::array();
    for (const auto& g : file.groups)
    {
        names += (names.empty() ? "" : ", ") + g.name + " (" + count(g.vertices.size()) + ")";
        report.details["groups"].push_back(
            {{"name", g.name}, {"dimension", g.dimension}, {"vertices", g.vertices.size()}});
    }
    report.lines.emplace_back("groups", names.empty() ? "none" : names + " vertices");
}

template <class Element>
void report_cells(check_report& report, const volume_case<Element>& input)
{
    constexpr int D = Element::dimension;
    const auto x = input.points();
    const auto state = input.look_as_read(x);
    report.map = state.simplices;
    report.map.flipped = state.inverted.size();
    report.has_map = true;
    const auto components = impl::components(input.simplices()).first.size();
    const auto boundary = impl::boundary_facets(input.simplices(), input.owners()).size();
    report.details["components"] = components;
    report.details["quality"] = shapes_json(state.shapes);
    report.lines.emplace_back("components", count(components));
    report.lines.emplace_back("orientation", "as " + input.file().format + " files have it");
    report.details["orientation"] = input.file().format;
    if (!input.parts().overlapping)
        report.lines.emplace_back("boundary", count(boundary, Element::facet_name, Element::facet_names));
    report.lines.emplace_back("inverted", count(state.inverted.size()) + " of " + count(input.cells()));
    report.lines.emplace_back("shapes", shapes_text(state.shapes));
    report.lines.emplace_back("jacobian", "scaled " + number(state.shapes.worst.scaled_jacobian) + " worst, " +
                                              number(state.shapes.scaled_jacobian) + " mean");
    std::string worst;
    for (const idx c : state.shapes.worst_ids) worst += (worst.empty() ? "" : ", ") + std::to_string(c);
    report.lines.emplace_back("worst", "cells " + worst);

    if (D == 3 && input.parts().overlapping)
    {
        report.details["insides"] = insides_json(state);
        report.lines.emplace_back("insides", insides_text(state));
        if (!state.negative_inside.empty())
            report.add({true, "mesh", "negative_inside", state.negative_inside,
                        list_cells(input, state.negative_inside) +
                            " with positive corners and a negative Jacobian inside; move a vertex of each"},
                       exit_code::unsuitable_input);
    }
    report_signs(report, input, state);
    if (!state.simplices && input.look(x).simplices)
        report.add({true, "mesh", "single_precision", state.inverted,
                    "read in the single precision that the file declares the mesh has " +
                        impl::describe_defects<Element>(state.simplices, input.owners()) +
                        "; save it in double precision, or move it to the origin"},
                   exit_code::unsuitable_input);
    if (!input.parts().overlapping)
        report_facets(report, input.simplices());
    else
        report_faces(report, input.file());
    if (report.map.flipped == 0 && report.map.branched > 0)
        report.add({true, "mesh", D == 2 ? "branch_points" : "branch_edges", report.map.branch_ids,
                    impl::describe_defects<Element>(report.map)},
                   exit_code::unsuitable_input);
}

template void report_cells(check_report&, const volume_case<triangle>&);
template void report_cells(check_report&, const volume_case<tetrahedron>&);

} // namespace taut::tools
