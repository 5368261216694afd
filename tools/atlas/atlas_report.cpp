// SPDX-License-Identifier: MIT
#include "atlas/atlas_report.hpp"

#include <charconv>
#include <cmath>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/files/surface/obj_output.hpp>

#include "shared/assessment.hpp"
#include "shared/peak_memory.hpp"
#include "shared/printable.hpp"
#include "shared/repair_report.hpp"
#include "shared/report_files.hpp"
#include "shared/run_clock.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

/// All but the charts.
nlohmann::ordered_json head_of(const atlas_run_report& r, const atlas_options& o)
{
    const auto& a = r.atlas;
    nlohmann::ordered_json json;
    json["schema"] = "taut.atlas/1";
    json["surfaces"] = nlohmann::ordered_json::array();
    for (const auto& s : r.surfaces)
        json["surfaces"].push_back({{"input", s.input},
                                    {"output", s.output},
                                    {"vertices", s.vertices},
                                    {"faces", s.triangles},
                                    {"mapped", s.mapped},
                                    {"repairs", tools::to_json(s.repairs)}});
    json["device"] = r.device;
    json["complete"] = a.complete;
    json["charts"] = a.charts.size();
    json["distortion"] = finite(a.distortion);
    json["worst_distortion"] = finite(a.worst);
    json["utilization"] = a.utilization;
    json["flipped"] = a.flips.flipped;
    json["branch_points"] = a.flips.branched;
    json["overlaps"] = a.overlaps;
    if (o.stack) json["stacked"] = a.stacked;
    json["convex_polygons"] = a.polygons;
    json["concave_polygons"] = a.concave;
    json["reversed_fans"] = r.reversed_fans;
    json["seam_length"] = a.seam_length;
    json["relative_seam"] = finite(a.seam_length / std::sqrt(a.area));
    if (a.seen_seam) json["seen_seam"] = *a.seen_seam;
    json["stretch_l2"] = finite(a.stretch_l2);
    json["stretch_linf"] = finite(a.stretch_linf);
    json["area_distortion"] = finite(a.area_distortion);
    json["area_difference"] = finite(a.area_difference);
    json["density_spread"] = finite(a.density_spread);
    json["large_charts"] =
        std::count_if(a.charts.begin(), a.charts.end(), [](const chart_summary& c) { return c.triangles > 10; });
    if (a.symmetry)
        json["symmetry"] = {{"normal", {a.symmetry->normal.x, a.symmetry->normal.y, a.symmetry->normal.z}},
                            {"offset", a.symmetry->offset},
                            {"pairs", a.symmetry->pairs},
                            {"own", a.symmetry->own}};
    json["resolution"] = a.resolution;
    json["padding"] = padding_of(o);
    json["least_distance"] = finite(a.least_distance);
    json["tiles"] = a.tiles;
    json["seconds"] = {{"read", r.read},
                       {"device", r.queue},
                       {"setup", a.seconds.setup},
                       {"charts", a.seconds.charts},
                       {"flatten", a.seconds.flatten},
                       {"pack", a.seconds.pack},
                       {"certify", a.seconds.certify},
                       {"draw", r.draw},
                       {"write", r.write},
                       {"total", r.total}};
    json["peak_memory_bytes"] = peak_memory();
    json["notes"] = r.notes;
    return json;
}

/// A number as JSON has it, which has none that is not finite.
void append_json(std::string& text, double x)
{
    char digits[32];
    text += std::isfinite(x) ? std::string_view(digits, std::to_chars(digits, std::end(digits), x).ptr) : "null";
}

} // namespace

void write_stats(io::atomic_file& file, const atlas_run_report& r, const atlas_options& o)
{
    std::string head = text_of(head_of(r, o));
    head.erase(head.rfind("\n}")); // charts follow, a line each: there may be tens of thousands
    file.write(head + ",\n  \"chart_table\": [");
    const auto& charts = r.atlas.charts;
    io::impl::write_items(file, charts.size(),
                          [&](std::string& text, std::size_t k)
                          {
                              const auto& c = charts[k];
                              text += k == 0 ? "\n    {\"triangles\": " : ",\n    {\"triangles\": ";
                              io::impl::append_number(text, c.triangles);
                              text += ", \"tile\": ";
                              io::impl::append_number(text, c.tile);
                              text += ", \"area\": ";
                              append_json(text, c.area);
                              text += ", \"energy\": ";
                              append_json(text, c.energy);
                              text += '}';
                          });
    file.write("\n  ]\n}\n");
}

std::string text_of(const atlas_run_report& r, const atlas_options& o)
{
    for (const auto& note : r.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    const auto& a = r.atlas;
    labelled_lines lines;
    std::vector<std::string> files;
    for (const auto& s : r.surfaces)
    {
        const auto all = static_cast<std::uint64_t>(s.triangles), mapped = static_cast<std::uint64_t>(s.mapped);
        lines.add("mesh", s.input + ": " + count(static_cast<std::uint64_t>(s.vertices), "vertex", "vertices") + ", " +
                              count(all, "triangle", "triangles") +
                              (mapped < all ? ", " + count(all - mapped) + " left out" : ""));
        describe(lines, s.repairs);
        if (files.empty() || s.output != files.front()) files.push_back(s.output);
    }
    lines.add("device", r.device_label);
    lines.add("charts", count(a.charts.size(), "chart", "charts") + ", seams of length " + number(a.seam_length) +
                            ", " + number(a.seam_length / std::sqrt(a.area), 3) + " by the root of the area" +
                            (a.seen_seam ? ", " + number(100 * *a.seen_seam, 3) + " % seen" : ""));
    if (a.stacked > 0)
        lines.add("stacks", count(static_cast<std::uint64_t>(a.stacked), "chart lies", "charts lie") + " on a copy");
    if (const auto& s = a.symmetry)
        lines.add("symmetry", count(static_cast<std::uint64_t>(s->pairs), "pair of charts", "pairs of charts") + ", " +
                                  count(static_cast<std::uint64_t>(s->own), "chart that is its own image",
                                        "charts that are their own images") +
                                  ", in the plane of normal (" + number(s->normal.x) + ", " + number(s->normal.y) +
                                  ", " + number(s->normal.z) + ") at " + number(s->offset));
    lines.add("distortion", "isometric energy " + number(a.distortion, 6) + " by area, " + number(a.worst, 4) +
                                " in the worst chart; 4 is none; stretch L2 " + number(a.stretch_l2, 5));
    lines.add("atlas", number(100 * a.utilization, 3) + " % of " +
                           (a.tiles > 1 ? count(static_cast<std::uint64_t>(a.tiles)) + " squares" : "the square") +
                           " used, charts " + number(a.least_distance, 3) + " texels apart at " +
                           std::to_string(a.resolution));
    lines.add("certificate", count(a.flips.flipped, "flip", "flips") + ", " + count(a.overlaps, "overlap", "overlaps") +
                                 (a.polygons > 0 ? ", " + count(a.concave) + " of " + count(a.polygons) +
                                                       " convex polygons not convex in the map"
                                                 : "") +
                                 (a.complete ? "" : "; ended early"));
    lines.add("time", duration(r.total) + ": read " + duration(r.read) + ", device " + duration(r.queue) + ", setup " +
                          duration(a.seconds.setup) + ", charts " + duration(a.seconds.charts) + ", flatten " +
                          duration(a.seconds.flatten) + ", pack " + duration(a.seconds.pack) + ", certify " +
                          duration(a.seconds.certify) + (r.draw > 0 ? ", draw " + duration(r.draw) : "") + ", write " +
                          duration(r.write));
    lines.add("memory", number(static_cast<double>(peak_memory()) / (1 << 20), 3) + " MiB at most");
    files.insert(files.end(), {o.picture, o.render, o.report, o.stats});
    lines.add_written(files);
    return (std::ostringstream() << lines).str();
}

std::vector<report::stage> stages(const atlas_run_report& r)
{
    const auto& s = r.atlas.seconds;
    std::vector<report::stage> result{{"read", r.read},
                                      {"device", r.queue},
                                      {"setup", s.setup},
                                      {"charts", s.charts},
                                      {"flatten", s.flatten, r.atlas.distortion},
                                      {"pack", s.pack},
                                      {"certify", s.certify}};
    return result;
}

std::vector<std::pair<std::string, std::string>> numbers(const atlas_run_report& r)
{
    const auto& a = r.atlas;
    std::uint64_t triangles = 0;
    for (const auto& s : r.surfaces) triangles += static_cast<std::uint64_t>(s.mapped);
    return {{"triangles", count(triangles)},
            {"charts", count(a.charts.size())},
            {"distortion", number(a.distortion, 6)},
            {"worst chart", number(a.worst, 4)},
            {"used", number(100 * a.utilization, 3) + " %"},
            {"flipped", count(a.flips.flipped)},
            {"overlaps", count(a.overlaps)},
            {"seams", number(a.seam_length)},
            {"apart", number(a.least_distance, 3) + " texels of " + std::to_string(a.resolution)}};
}

std::vector<double> triangle_energies(const atlas& made, double aspect)
{
    std::vector<vec2> uv = made.uv;
    for (vec2& x : uv) x.y *= aspect;
    const auto& cut = made.charts.surface;
    const impl::ideal_elements<triangle> ideal(cut);
    std::vector<double> energy(cut.cells().size());
    for (std::size_t i = 0; i < energy.size(); ++i)
    {
        const mat2 S =
            impl::shape_matrix<2>(cut.cells()[i], std::span<const vec2>(uv), ideal.inverse[i]) / made.layout.scale;
        energy[static_cast<std::size_t>(made.charts.cell_origins[i])] =
            energy::isometric{}(element<double, 2>{S, glm::determinant(S), ideal.measure[i]});
    }
    return energy;
}

} // namespace taut::tools
