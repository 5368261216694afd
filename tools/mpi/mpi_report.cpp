// SPDX-License-Identifier: MIT
#include "mpi/mpi_report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "shared/printable.hpp"
#include "shared/report_files.hpp"
#include "shared/run_clock.hpp"
#include "shared/text_table.hpp"
#include "volume/shape_report.hpp"

namespace taut::tools::mpi
{

namespace
{

/// JSON has no number for what is not finite.
nlohmann::ordered_json numeric(double x)
{
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json traffic_json(const traffic& t)
{
    return {{"messages", t.messages}, {"bytes", t.bytes}, {"reductions", t.reductions}, {"exchanges", t.exchanges}};
}

nlohmann::ordered_json process_json(const process_numbers& p)
{
    const auto& s = p.seconds;
    return {{"vertices", p.own_vertices},
            {"halo_vertices", p.halo_vertices},
            {"elements", p.cells},
            {"peak_memory_bytes", p.peak_memory},
            {"device_bytes", p.device_bytes},
            {"processor_seconds", p.processor},
            {"seconds",
             {{"read", p.read},
              {"distribute", s.distribute},
              {"plan", s.plan},
              {"start", s.start},
              {"values", s.values},
              {"linearize", s.linearize},
              {"setup", s.setup},
              {"apply", s.apply},
              {"products", s.products},
              {"certify", s.certify},
              {"write", p.write}}},
            {"sent", {{"distribute", traffic_json(p.distributed)}, {"solve", traffic_json(p.solved)}}}};
}

} // namespace

nlohmann::ordered_json to_json(const mpi_report& r, const mpi_options& o)
{
    const dist::report& run = r.run;
    nlohmann::ordered_json json;
    json["schema"] = o.shape.smoothing ? "taut.mpi.smooth/1" : "taut.mpi.deform/1";
    json["input"] = o.shape.input;
    json["output"] = o.shape.output;
    json["format"] = r.format;
    json["read"] = r.read_whole.empty() ? "by ranges" : "by process 0: " + r.read_whole;
    json["element"] = r.mixed ? "mixed" : r.element;
    json["vertices"] = r.vertices;
    json["elements"] = r.elements;
    json["pins"] = r.pins;
    json["springs"] = r.springs;
    json["device"] = r.device;
    json["preconditioner"] = dist::to_string(o.solver.preconditioner);
    json["partition"] = dist::to_string(o.solver.partition);
    json["petsc"] = o.solver.options;
    json["outcome"] = run.pins_held || run.outcome == outcome::valid ? "valid" : "stopped";
    json["reason"] = run.reason;
    json["converged"] = run.converged;
    json["pins_held"] = run.pins_held;
    json["distance"] = run.distance;
    json["energy"] = numeric(run.energy);
    json["gradient"] = numeric(run.gradient);
    json["iterations"] = run.steps;
    json["products"] = run.products;
    json["setups"] = run.setups;
    json["fallbacks"] = run.fallbacks;
    json["inverted_start"] = r.before.inverted.size();
    json["inverted"] = r.after.inverted.size();
    json["branch_edges"] = r.after.simplices.branched;
    if (r.mixed && r.dimension == 3) json["insides"] = insides_json(r.after);
    json["quality_start"] = shapes_json(r.before.shapes);
    json["quality"] = shapes_json(r.after.shapes);
    json["seconds"] = {{"read", r.seconds.read},
                       {"distribute", r.seconds.distribute},
                       {"solve", r.seconds.solve},
                       {"total", r.seconds.total}};
    json["processes"] = nlohmann::ordered_json::array();
    for (const auto& p : r.processes) json["processes"].push_back(process_json(p));
    json["notes"] = run.notes;
    return json;
}

std::string text_of(const mpi_report& r, const mpi_options& o)
{
    const dist::report& run = r.run;
    for (const auto& note : run.notes) std::cerr << "taut-mpi: note: " << printable(note) << '\n';
    if (!run.pins_held && !run.reason.empty()) std::cerr << "taut-mpi: note: " << printable(run.reason) << '\n';
    std::uint64_t memory = 0;
    for (const auto& p : r.processes) memory = std::max(memory, p.peak_memory);
    labelled_lines lines;
    lines.add("mesh", o.shape.input + ": " + count(r.vertices, "vertex", "vertices") + ", " + r.cells +
                          (o.shape.smoothing ? "" : ", " + count(r.pins) + " vertices held"));
    lines.add("processes",
              count(r.processes.size()) + ", " + number(static_cast<double>(memory) / 1048576) + " MB of the largest");
    lines.add("device", r.device);
    lines.add("inverted", count(r.before.inverted.size()) + " -> " + count(r.after.inverted.size()));
    if (r.mixed && r.dimension == 3) lines.add("insides", insides_text(r.after));
    lines.add("energy", number(run.energy) + (run.converged ? ", converged" : ", not converged") + ", " +
                            count(static_cast<std::uint64_t>(run.steps), "step", "steps") + ", " +
                            count(static_cast<std::uint64_t>(run.products), "product", "products"));
    lines.add("before", shapes_text(r.before.shapes));
    lines.add("after", shapes_text(r.after.shapes));
    lines.add("time", duration(r.seconds.total) + ": read " + duration(r.seconds.read) + ", distribute " +
                          duration(r.seconds.distribute) + ", solve " + duration(r.seconds.solve));
    lines.add_written({o.shape.output, o.shape.stats});
    return (std::ostringstream() << lines).str();
}

} // namespace taut::tools::mpi
