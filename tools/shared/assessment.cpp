// SPDX-License-Identifier: MIT
#include "shared/assessment.hpp"
#include "shared/at.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/measure/distortion.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

namespace taut::tools
{

namespace
{

/// The triangles that have an area at rest.
std::vector<mesh<triangle>::cell> solid_cells(const mesh<triangle>& surface)
{
    auto [flat, inverted] = impl::bad_rest_cells(surface);
    std::vector<char> keep(surface.cells().size(), 1);
    for (const idx c : flat) keep[at(c)] = 0;
    std::vector<mesh<triangle>::cell> cells;
    for (std::size_t c = 0; c < keep.size(); ++c)
        if (keep[c]) cells.push_back(surface.cells()[c]);
    return cells;
}

void look_at_boundary(assessment& a, const mesh<triangle>& surface, std::span<const vec2> uv)
{
    const auto sides = impl::facets(surface);
    if (!sides.manifold() || !sides.oriented())
    {
        a.notes.push_back("the boundary is not defined: " + std::string(sides.manifold()
                                                                            ? "neighbours are oriented differently"
                                                                            : "an edge has three or more triangles"));
        return;
    }
    const auto loops = boundary_loops(surface, sides);
    a.boundaries = loops.size();
    a.crossings = impl::count_boundary_crossings(loops, uv);
}

nlohmann::ordered_json to_json(const spread& s)
{
    return {{"min", finite(s.min)}, {"max", finite(s.max)}, {"rms", finite(s.rms)}};
}

nlohmann::ordered_json to_json(const impl::means& m, const char* by_measure)
{
    return {{by_measure, finite(m.measure)}, {"mean", finite(m.uniform)}};
}

/// ": 5, 9, 12, ...", the first of n.
std::string first_ids(const std::vector<idx>& ids, std::size_t n)
{
    constexpr std::size_t most = 5;
    std::string text;
    for (std::size_t k = 0; k < std::min(ids.size(), most); ++k)
        text += (k == 0 ? ": " : ", ") + std::to_string(ids[k]);
    return text + (n > most ? ", ..." : "");
}

} // namespace

assessment assess(const mesh<triangle>& surface, std::span<const vec2> uv)
{
    assessment a;
    a.vertices = surface.vertex_count();
    auto solid = solid_cells(surface);
    a.left_out = surface.cells().size() - solid.size();
    if (a.left_out == 0)
        a.quality = measure_quality(surface, uv);
    else
    {
        a.notes.push_back(count(a.left_out, "triangle", "triangles") +
                          " without area on the surface: left out of everything but the count of flips");
        const auto all = certify<2>(surface.cells(), uv);
        if (!solid.empty()) a.quality = measure_quality(mesh<triangle>(surface.points(), std::move(solid)), uv);
        // Which triangles are flipped does not depend on the surface; the range of det does.
        a.quality.flips.take_defects(all);
    }
    if (a.quality.flips.flipped == a.quality.flips.elements && a.quality.flips.max_det < 0)
        a.notes.push_back("the map is mirrored as a whole: negate u to reflect it");
    look_at_boundary(a, surface, uv);
    return a;
}

assessment certified(const mesh<triangle>& surface, std::span<const vec2> uv)
{
    assessment a;
    a.vertices = surface.vertex_count();
    a.measured = false;
    a.quality.flips = certify<2>(surface.cells(), uv);
    return a;
}

void take_polygons(assessment& a, const impl::convex_polygons& polygons, std::span<const vec2> uv)
{
    a.polygons = static_cast<std::size_t>(polygons.size());
    for (const idx k : impl::find_concave(polygons, uv)) a.concave.push_back(polygons.numbers[at(k)]);
}

void add_polygons(nlohmann::ordered_json& json, const assessment& a)
{
    json["convex_polygons"] = a.polygons;
    json["concave_polygons"] = a.concave.size();
    json["reversed_fans"] = a.reversed_fans;
    json["concave_polygon_ids"] = std::vector<idx>(
        a.concave.begin(), a.concave.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(a.concave.size(), 8)));
}

nlohmann::ordered_json finite(double x)
{
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const quality& q, int dimension)
{
    const char* by_measure = dimension == 2 ? "by_area" : "by_volume";
    nlohmann::ordered_json json;
    json["isometric"] = to_json(q.isometric, by_measure);
    json["shape"] = to_json(q.shape, by_measure);
    json["area"] = to_json(q.area, by_measure);
    json["stretch_l2"] = to_json(q.stretch_l2);
    json["stretch_l2_total"] = finite(q.stretch_l2_total);
    json["stretch_linf"] = to_json(q.stretch_linf);
    json["area_ratio"] = to_json(q.area_ratio);
    json["angular"] = finite(q.angular);
    json["scale"] = finite(q.scale);
    return json;
}

nlohmann::ordered_json to_json(const assessment& a)
{
    if (!a.measured) return nullptr;
    auto json = to_json(a.quality, 2);
    json["boundaries"] = a.boundaries;
    json["boundary_crossings"] =
        a.crossings ? nlohmann::ordered_json(a.crossings->pairs) : nlohmann::ordered_json(nullptr);
    json["all_crossings_counted"] = a.crossings && a.crossings->all;
    json["left_out"] = a.left_out;
    return json;
}

void describe_validity(labelled_lines& lines, const assessment& a)
{
    const auto& flips = a.quality.flips;
    lines.add("flipped", count(flips.flipped) + " of " + count(flips.elements) + first_ids(flips.ids, flips.flipped) +
                             "; det " + number(flips.min_det) + " .. " + number(flips.max_det));
    lines.add("winding", flips.branched == 0
                             ? "once around every inner vertex"
                             : "more than once around " + count(flips.branched, "vertex", "vertices") +
                                   first_ids(flips.branch_ids, flips.branched) + ": the map overlaps there");
    if (a.polygons > 0)
        lines.add("polygons", count(a.concave.size()) + " of " + count(a.polygons) +
                                  " that are convex in space are not in the map" +
                                  first_ids(a.concave, a.concave.size()) +
                                  (a.concave.empty() ? "" : "; cut along other diagonals, triangles turn over"));
    if (!a.measured) return;
    lines.add("boundary", count(a.boundaries, "loop", "loops") + ", " +
                              (a.crossings ? std::string(a.crossings->all ? "" : "at least ") +
                                                 count(a.crossings->pairs, "crossing", "crossings") +
                                                 (a.crossings->pairs > 0 ? ": the flat parts overlap or touch" : "")
                                           : "crossings unknown"));
}

void print(std::ostream& out, const assessment& a)
{
    if (a.measured) print(out, a.quality, 2);
}

void print(std::ostream& out, const quality& q, int dimension)
{
    text_table energies;
    energies.add({"energy", dimension == 2 ? "by area" : "by volume", "mean", "isometry"});
    const auto energy = [&](const char* name, const impl::means& m, const char* least) {
        energies.add({name, number(m.measure), number(m.uniform), least});
    };
    energy("isometric", q.isometric, dimension == 2 ? "4" : "2");
    energy("shape", q.shape, "1");
    energy(dimension == 2 ? "area" : "volume", q.area, "2");

    text_table spreads;
    spreads.add({"ratio", "min", "max", "rms - 1"});
    const auto row = [&](const char* name, const spread& s) {
        spreads.add({name, number(s.min), number(s.max), number(s.rms)});
    };
    row("stretch L2", q.stretch_l2);
    row("stretch Linf", q.stretch_linf);
    row(dimension == 2 ? "area" : "volume", q.area_ratio);
    spreads.add({"angular", "", "", number(q.angular)});
    out << '\n' << energies << '\n' << spreads;
}

} // namespace taut::tools
