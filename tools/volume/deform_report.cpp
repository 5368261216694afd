// SPDX-License-Identifier: MIT
#include "volume/deform_report.hpp"

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

nlohmann::ordered_json to_json(const deform_report& r, const shape_options& o)
{
    const session_report& run = r.run;
    nlohmann::ordered_json json;
    json["schema"] = o.smoothing ? "taut.smooth/1" : "taut.deform/1";
    json["input"] = o.input;
    json["output"] = o.output;
    json["format"] = r.format;
    json["element"] = r.element;
    json["vertices"] = r.vertices;
    json["elements"] = r.elements;
    json["pins"] = r.pins;
    json["springs"] = r.springs;
    json["device"] = r.device;
    json["outcome"] = run.pins_held || run.outcome == outcome::valid ? "valid" : "stopped";
    json["reason"] = run.reason;
    if (!o.smoothing) json["refined"] = refined_json(r.refined);
    json["converged"] = run.converged;
    json["pins_held"] = run.pins_held;
    json["pin_rounding"] = r.pin_rounding;
    json["farthest"] = run.farthest;
    json["distance"] = run.distance;
    json["energy"] = finite(run.energy);
    json["gradient"] = finite(run.gradient);
    json["iterations"] = run.steps;
    json["inverted_start"] = r.before.inverted.size();
    json["inverted"] = r.after.inverted.size();
    json["branch_edges"] = r.dimension == 3 ? r.after.simplices.branched : 0;
    json["branch_points"] = r.dimension == 2 ? r.after.simplices.branched : 0;
    if (r.has_insides()) json["insides"] = insides_json(r.after);
    json["quality_start"] = shapes_json(r.before.shapes);
    json["quality"] = shapes_json(r.after.shapes);
    json["seconds"] = {{"read", r.seconds.read},       {"device", r.seconds.device},   {"start", run.seconds.start},
                       {"follow", run.seconds.follow}, {"repair", run.seconds.repair}, {"solve", run.seconds.solve},
                       {"total", r.seconds.total}};
    json["stages"] = to_json_array(run.stages);
    json["peak_memory_bytes"] = peak_memory();
    json["notes"] = run.notes;
    return json;
}

std::string text_of(const deform_report& r, const shape_options& o)
{
    const session_report& run = r.run;
    for (const auto& note : run.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    if (!run.pins_held && !run.reason.empty()) std::cerr << "taut: note: " << printable(run.reason) << '\n';
    labelled_lines lines;
    lines.add("mesh", o.input + ": " + count(r.vertices, "vertex", "vertices") + ", " + r.cells +
                          (o.smoothing ? "" : ", " + count(r.pins) + " vertices held"));
    lines.add("device", r.device);
    lines.add("inverted", count(r.before.inverted.size()) + " -> " + count(r.after.inverted.size()));
    if (r.has_insides()) lines.add("insides", insides_text(r.after));
    if (r.refined) lines.add("refined", refined_text(*r.refined));
    lines.add("energy", number(run.energy) + (run.converged ? ", converged" : ", not converged") + ", " +
                            count(static_cast<std::uint64_t>(run.steps), "step", "steps"));
    lines.add("before", shapes_text(r.before.shapes));
    lines.add("after", shapes_text(r.after.shapes));
    lines.add("time", duration(r.seconds.total) + ": read " + duration(r.seconds.read) + ", device " +
                          duration(r.seconds.device) + ", solve " + duration(r.seconds.solve));
    lines.add_written({o.output, o.refined_map, o.picture, o.stats});
    return (std::ostringstream() << lines).str();
}

} // namespace taut::tools
