// SPDX-License-Identifier: MIT
#include "untangle_report.hpp"

#include <cmath>
#include <iostream>
#include <sstream>

#include "assessment.hpp"
#include "run_clock.hpp"
#include "stages.hpp"
#include "text_table.hpp"

namespace taut::tools
{

nlohmann::ordered_json to_json(const untangle_report& r, const untangle_options& o)
{
    nlohmann::ordered_json json;
    json["schema"] = "taut.untangle/1";
    json["input"] = o.input;
    json["output"] = r.written.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(r.written);
    json["element"] = r.element;
    json["vertices"] = r.vertices;
    json["elements"] = r.elements;
    json["pinned"] = r.pinned;
    json["device"] = r.device;
    json["outcome"] = r.outcome;
    json["reason"] = r.reason;
    json["ids"] = r.ids;
    json["inverted_start"] = r.before.flipped;
    json["inverted"] = r.after.flipped;
    json["branch_points_start"] = r.before.branched;
    json["branch_points"] = r.after.branched;
    json["min_det"] = finite(r.least_det);
    json["min_relative_det"] = finite(r.least_relative_det);
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
    for (const auto& note : r.notes) std::cerr << "taut: note: " << note << '\n';
    labelled_lines lines;
    lines.add("problem", o.input + ": " + count(r.vertices, "vertex", "vertices") + ", " + count(r.elements) + ' ' +
                             r.element_names + ", " + count(r.pinned) + " vertices pinned");
    if (!r.device_label.empty()) lines.add("device", r.device_label);
    lines.add("inverted", count(r.before.flipped) + " -> " + count(r.after.flipped) + " of " + count(r.elements));
    if (r.before.branched + r.after.branched > 0)
        lines.add("branch points", count(r.before.branched) + " -> " + count(r.after.branched));
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
    std::string files = r.written;
    for (const auto& file : {o.picture, o.stats})
        if (!file.empty()) files += (files.empty() ? "" : ", ") + file;
    if (!files.empty()) lines.add("wrote", files);
    return (std::ostringstream() << lines).str();
}

} // namespace taut::tools
