// SPDX-License-Identifier: MIT
#include "shared/seams.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/cut_to_disk.hpp>

#include "shared/failure.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

/// Returns whether a fault is one of the pieces that a cut leaves, not of some triangles.
bool is_of_pieces(const mesh_finding& f)
{
    return f.fault == mesh_error::several_components || f.fault == mesh_error::closed_surface ||
           f.fault == mesh_error::several_boundaries || f.fault == mesh_error::handles ||
           f.fault == mesh_error::non_manifold_vertex;
}

/// "6 charts with 7 boundary loops"
std::string describe_pieces(const mesh<triangle>& cut, const impl::facet_table& sides,
                            const std::vector<mesh_finding>& faults)
{
    const auto found = [&](mesh_error::fault_type fault)
    { return std::find_if(faults.begin(), faults.end(), [&](const mesh_finding& f) { return f.fault == fault; }); };
    const auto parts = found(mesh_error::several_components);
    std::string text = count(parts == faults.end() ? 1 : parts->ids.size(), "chart", "charts");
    if (sides.oriented())
        text += " with " + count(boundary_loops(cut, sides).size(), "boundary loop", "boundary loops");
    if (found(mesh_error::handles) != faults.end()) text += " and handles";
    const auto touching = found(mesh_error::non_manifold_vertex);
    if (touching != faults.end()) text += ", whose parts touch in " + count(touching->ids.size(), "vertex", "vertices");
    return text;
}

} // namespace

std::optional<io::cut_surface> cut_open(const io::surface_file& file, mesh_requirements need, bool wanted)
{
    need.referenced = false;
    if (file.texcoords.empty()) return std::nullopt;
    std::optional<io::cut_surface> cut;
    try
    {
        cut = file.cut_seams();
    }
    catch (const io::texcoord_error&)
    {
        if (wanted) throw;
    }
    if (!cut || (!wanted && check(file.surface, need).empty())) return std::nullopt;
    const auto sides = impl::facets(cut->surface);
    const auto faults = check(cut->surface, sides, need);
    if (std::any_of(faults.begin(), faults.end(), is_of_pieces))
        throw unsuitable_input("cut open along the seams of its vt, the surface is " +
                               describe_pieces(cut->surface, sides, faults) +
                               ", not one disk; give it seams that leave one, or map the charts one at a time");
    return cut;
}

std::optional<io::cut_surface> cut_to_one_disk(const io::surface_file& file)
{
    const auto& m = file.surface;
    const auto f = impl::facets(m);
    validate(m, f, {.referenced = false, .open = false, .one_boundary = false, .no_handles = false});
    if (check(m, f, {.referenced = false}).empty()) return std::nullopt;
    const auto polygon = file.faces.of_triangles();
    std::vector<char> diagonals(polygon.empty() ? 0 : f.twin.size(), 0);
    for (std::size_t s = 0; s < diagonals.size(); ++s)
        if (const idx twin = f.twin[s]; twin >= 0)
            diagonals[s] = polygon[s / 3] == polygon[static_cast<std::size_t>(twin) / 3];
    const auto made = cut_charts(m, f, cut_to_disk(m, f, diagonals));
    // The first sheet of a vertex has its number, further ones follow.
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<vec3> points = m.points();
    std::vector<idx> origins(points.size()), sheet(made.vertex_origins.size());
    std::iota(origins.begin(), origins.end(), idx(0));
    std::vector<char> taken(points.size(), 0), divided(points.size(), 0);
    std::size_t seam_vertices = 0;
    for (std::size_t i = 0; i < sheet.size(); ++i)
    {
        const idx v = made.vertex_origins[i];
        sheet[i] = taken[u(v)] ? static_cast<idx>(points.size()) : v;
        if (taken[u(v)])
        {
            points.push_back(vec3(points[u(v)]));
            origins.push_back(v);
            seam_vertices += divided[u(v)] ? 0 : 1;
            divided[u(v)] = 1;
        }
        taken[u(v)] = 1;
    }
    std::vector<std::array<idx, 3>> cells(m.cells().size());
    std::vector<idx> corners(file.faces.corners.size(), -1);
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
        const auto c = u(made.cell_origins[i]);
        for (std::size_t k = 0; k < 3; ++k)
        {
            cells[c][k] = sheet[u(made.surface.cells()[i][k])];
            corners[file.faces.corner(c, k)] = cells[c][k]; // the same in all triangles of a polygon
        }
    }
    std::vector<vec2> uv(points.size(), vec2(0.0));
    return io::cut_surface{mesh<triangle>(std::move(points), std::move(cells)), std::move(uv), std::move(origins),
                           std::move(corners), seam_vertices};
}

std::string describe(const io::cut_surface& cut)
{
    return "cut open along the seams of its vt, on which " + count(cut.seam_vertices, "vertex lies", "vertices lie");
}

std::vector<idx> divided_vertices(const io::cut_surface& cut)
{
    // Further sheets follow the vertices of the file.
    std::vector<idx> divided;
    for (std::size_t s = 0; s < cut.origins.size(); ++s)
        if (cut.origins[s] != static_cast<idx>(s)) divided.push_back(cut.origins[s]);
    std::sort(divided.begin(), divided.end());
    return divided;
}

void require_undivided(std::span<const io::pin<2>> pins, std::span<const idx> divided)
{
    for (const auto& pin : pins)
        if (const auto sheets = std::equal_range(divided.begin(), divided.end(), pin.vertex);
            sheets.first != sheets.second)
            throw unsuitable_input(
                "the pin of vertex " + std::to_string(pin.vertex) + ": it lies on a seam, which divides it into " +
                std::to_string(sheets.second - sheets.first + 1) + " vertices; pin others, or close the seam");
}

} // namespace taut::tools
