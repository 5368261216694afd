// SPDX-License-Identifier: MIT
#include "untangle/untangle_report.hpp"

#include <cmath>
#include <iostream>
#include <sstream>

#include "shared/assessment.hpp"
#include "shared/peak_memory.hpp"
#include "shared/printable.hpp"
#include "shared/run_clock.hpp"
#include "shared/stages.hpp"
#include "shared/text_table.hpp"
#include "volume/shape_report.hpp"

namespace taut::tools
{

nlohmann::ordered_json to_json(const untangle_report& r, const untangle_options& o)
{
    nlohmann::ordered_json json;
    json["schema"] = "taut.untangle/1";
    json["input"] = o.input;
    json["output"] = r.written.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(r.written);
    if (!r.format.empty()) json["format"] = r.format;
    json["element"] = r.element;
    json["vertices"] = r.vertices;
    json["elements"] = r.elements;
    json["pinned"] = r.pinned;
    if (!r.format.empty()) json["pin_rounding"] = r.pin_rounding;
    json["device"] = r.device;
    json["outcome"] = r.outcome;
    json["reason"] = r.reason;
    json["ids"] = r.ids;
    json["inverted_start"] = r.before.flipped;
    json["inverted"] = r.after.flipped;
    for (const auto& [suffix, map] : {std::pair{"_start", &r.before}, {"", &r.after}})
        json[(r.dimension == 2 ? "branch_points" : "branch_edges") + std::string(suffix)] = map->branched;
    if (!r.format.empty())
    {
        if (r.dimension == 3 && !r.written.empty() && r.element == std::string("mixed"))
            json["insides"] = insides_json(r.state_after);
        json["quality_start"] = shapes_json(r.state_before.shapes);
        json["quality"] = r.written.empty() ? nlohmann::ordered_json(nullptr) : shapes_json(r.state_after.shapes);
    }
    json["min_det"] = finite(r.least_det);
    json["min_relative_det"] = finite(r.least_relative_det);
    json["refined"] = refined_json(r.refined);
    json["stage"] = r.stage;
    json["stages"] = nlohmann::ordered_json::array();
    for (const auto& s : r.stages)
    {
        auto& stage = json["stages"].emplace_back(to_json(s));
        stage["name"] = s.stage;
        stage["inverted"] = s.inverted;
        stage["branch_points"] = s.branched;
    }
    json["seconds"] = {{"read", r.seconds.read},   {"check", r.seconds.check}, {"device", r.seconds.device},
                       {"solve", r.seconds.solve}, {"write", r.seconds.write}, {"total", r.seconds.total}};
    json["peak_memory_bytes"] = peak_memory();
    json["notes"] = r.notes;
    return json;
}

std::string text_of(const untangle_report& r, const untangle_options& o)
{
    for (const auto& note : r.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    labelled_lines lines;
    lines.add("problem", o.input + ": " + count(r.vertices, "vertex", "vertices") + ", " + r.cells + ", " +
                             count(r.pinned, "vertex pinned", "vertices pinned"));
    if (!r.device_label.empty()) lines.add("device", r.device_label);
    lines.add("inverted", count(r.before.flipped) + " -> " + count(r.after.flipped) + " of " + count(r.elements));
    if (r.before.branched + r.after.branched > 0)
        lines.add(r.dimension == 2 ? "branch points" : "branch edges",
                  count(r.before.branched) + " -> " + count(r.after.branched));
    if (!r.format.empty()) lines.add("before", shapes_text(r.state_before.shapes));
    if (!r.format.empty() && !r.written.empty()) lines.add("after", shapes_text(r.state_after.shapes));
    if (r.dimension == 3 && !r.written.empty() && r.element == std::string("mixed"))
        lines.add("insides", insides_text(r.state_after));
    if (r.refined) lines.add("refined", refined_text(*r.refined));
    lines.add("outcome", r.outcome + (r.stage.empty() ? "" : ", by " + r.stage));
    std::string stages;
    for (const auto& s : r.stages)
        stages += (stages.empty() ? "" : "; ") + s.stage + ' ' +
                  count(static_cast<std::uint64_t>(s.iterations), "iteration", "iterations") + ", " +
                  duration(s.seconds) + ", " + count(s.inverted) + " left";
    if (!stages.empty()) lines.add("stages", stages);
    if (!std::isnan(r.least_det))
        lines.add("least det", number(r.least_det) + ", relative to the mean " + number(r.least_relative_det));
    lines.add("time", duration(r.seconds.total) + ": read " + duration(r.seconds.read) + ", check " +
                          duration(r.seconds.check) + ", device " + duration(r.seconds.device) + ", solve " +
                          duration(r.seconds.solve) + ", write " + duration(r.seconds.write));
    const std::string table = r.code == exit_code::valid ? o.refined_map : "";
    lines.add_written({r.written, o.picture, table, o.stats});
    return (std::ostringstream() << lines).str();
}

} // namespace taut::tools
