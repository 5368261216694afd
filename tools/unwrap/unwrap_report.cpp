// SPDX-License-Identifier: MIT
#include "unwrap/unwrap_report.hpp"

#include <iostream>
#include <sstream>

#include "shared/interrupt.hpp"
#include "shared/peak_memory.hpp"
#include "shared/printable.hpp"
#include "shared/run_clock.hpp"
#include "shared/stages.hpp"
#include "shared/text_table.hpp"

#include <taut/impl/core/measure/distortion.hpp>

namespace taut::tools
{

namespace
{

impl::means mean_energy(const any_energy& energy, const mesh<triangle>& surface,
                        const impl::ideal_elements<triangle>& ideal, std::span<const vec2> uv)
{
    return impl::mean_over<triangle>(surface, ideal, uv,
                                     [&](const element<double, 2>& e)
                                     { return e.det > 0 ? energy(e) : std::numeric_limits<double>::infinity(); });
}

/// The stop in words.
std::string describe(const solve::report& r, const unwrap_options& options)
{
    using solve::stop;
    const std::string why = [&]() -> std::string
    {
        switch (r.stop)
        {
        case stop::gradient:
            return "converged: relative gradient " + number(r.gradient_norm, 2) +
                   " <= " + number(options.tolerance.value_or(solve::params{}.gradient_tolerance));
        case stop::settled:
            return "converged: negligible decrease over five steps, relative gradient " + number(r.gradient_norm, 2);
        case stop::decrement:
            return "converged: Newton decrement below tolerance, relative gradient " + number(r.gradient_norm, 2);
        case stop::decrease:
            return "converged: no further decrease of the energy, relative gradient " + number(r.gradient_norm, 2);
        case stop::step:
            return "converged: the steps are tiny, relative gradient " + number(r.gradient_norm, 2);
        case stop::iterations:
            return "limit of iterations, relative gradient " + number(r.gradient_norm, 2);
        case stop::line_search:
            return "no lower energy found (rounding), relative gradient " + number(r.gradient_norm, 2);
        case stop::barrier:
            return "triangles about to flip block every step, relative gradient " + number(r.gradient_norm, 2);
        case stop::time:
            return "time limit, relative gradient " + number(r.gradient_norm, 2);
        case stop::user:
            return "interrupted, relative gradient " + number(r.gradient_norm, 2);
        case stop::not_finite_start:
            return "the energy of the start is not finite in this precision; the start was written";
        }
        return {};
    }();
    return why;
}

std::string identifier(solve::stop stop)
{
    std::string word(to_string(stop));
    for (char& c : word)
        if (c == ' ') c = '_';
    return word;
}

std::string boundary_name(boundary_kind kind)
{
    return kind == boundary_kind::free ? "free" : kind == boundary_kind::circle ? "circle" : "square";
}

} // namespace

void unwrap_report::assess(const unwrap_options& options, const parameterize_params& params,
                           const mesh<triangle>& surface, std::span<const vec2> uv)
{
    summary_ = to_string(options.energy) + " energy, " + boundary_name(options.boundary) + " boundary, " +
               count(static_cast<std::uint64_t>(map.solve.iterations), "iteration", "iterations");
    if (map.solve.stop == solve::stop::time) code = exit_code::time_limit;
    if (map.solve.stop == solve::stop::user)
    {
        // Whoever asked it to stop does not wait for measures.
        code = interruption();
        energy_before = map.solve.value_start;
        energy = map.solve.value;
        after = certified(surface, uv);
        return;
    }
    const impl::ideal_elements<triangle> ideal(surface);
    const bool by_area = options.weights == energy::weighting::measure;
    // Energies and distortion are those at the size of the surface.
    std::vector<vec2> sized(uv.begin(), uv.end());
    for (vec2& p : sized) p /= map.scale;
    energy_end = mean_energy(params.energy, surface, ideal, sized);
    energy_before = map.solve.value_start;
    if (!map.start.uv.empty())
    {
        const auto start = mean_energy(params.energy, surface, ideal, map.start.uv);
        energy_before = by_area ? start.measure : start.uniform;
    }
    energy = by_area ? energy_end.measure : energy_end.uniform;
    after = tools::assess(surface, sized);
    // The certificate is that of exactly what is written.
    if (map.scale != 1) after.quality.flips.take_defects(certify<2>(surface.cells(), uv));
}

nlohmann::ordered_json to_json(const unwrap_report& r, const unwrap_options& o)
{
    const auto& flips = r.after.quality.flips;
    nlohmann::ordered_json json;
    json["schema"] = "taut.unwrap/1";
    json["input"] = o.input;
    json["output"] = o.output;
    json["vertices"] = r.after.vertices;
    json["faces"] = flips.elements;
    json["seam_vertices"] = r.seam_vertices;
    json["device"] = r.device;
    json["precision"] = to_string(r.map.precision);
    json["method"] = {{"energy", to_string(o.energy)},
                      {"weights", o.weights == energy::weighting::measure ? "measure" : "uniform"},
                      {"boundary", boundary_name(o.boundary)},
                      {"solver", to_string(o.solver)},
                      {"start", r.pins + r.springs > 0 ? "brought to the constraints" : describe_start(o)}};
    json["scale"] = r.map.scale;
    json["constraints"] = {{"pins", r.pins}, {"springs", r.springs}};
    json["untangling"] = nlohmann::ordered_json::array();
    for (const auto& stage : r.map.untangling)
        json["untangling"].push_back({{"stage", stage.stage},
                                      {"iterations", stage.iterations},
                                      {"inverted", stage.inverted},
                                      {"branch_points", stage.branched},
                                      {"seconds", stage.seconds}});
    if (const auto& overlap = r.map.overlap)
        json["overlap"] = {{"crossings_before", overlap->before.pairs},
                           {"all_crossings_counted", overlap->before.all},
                           {"energy_before", finite(overlap->energy_before)},
                           {"rounds", overlap->rounds},
                           {"crossings", overlap->crossings}};
    json["stop"] = identifier(r.map.solve.stop);
    json["iterations"] = r.map.solve.iterations;
    json["hessian_products"] = r.map.solve.products;
    json["eliminations"] = r.map.solve.eliminations;
    json["evaluations"] = r.map.solve.evaluations;
    json["gradients"] = r.map.solve.gradients;
    json["gradient"] = finite(r.map.solve.gradient_norm);
    json["energy_start"] = finite(r.energy_before);
    json["energy"] = finite(r.energy);
    json["flipped"] = flips.flipped;
    json["branch_points"] = flips.branched;
    add_polygons(json, r.after);
    json["min_det"] = finite(flips.min_det);
    json["max_det"] = finite(flips.max_det);
    json["seconds"] = {{"read", r.seconds.read},       {"device", r.seconds.queue + r.map.seconds.device},
                       {"setup", r.map.seconds.setup}, {"hierarchy", r.map.seconds.hierarchy},
                       {"start", r.map.seconds.start}, {"untangle", r.map.seconds.untangle},
                       {"solve", r.map.seconds.solve}, {"overlap", r.map.seconds.overlap},
                       {"quality", r.seconds.quality}, {"draw", r.seconds.draw},
                       {"write", r.seconds.write},     {"total", r.seconds.total}};
    json["levels"] = nlohmann::ordered_json::array();
    for (const auto& l : r.map.levels)
        json["levels"].push_back({{"level", l.level},
                                  {"vertices", l.vertices},
                                  {"iterations", l.solve.iterations},
                                  {"energy_start", finite(l.solve.value_start)},
                                  {"energy", finite(l.solve.value)},
                                  {"waits", l.solve.waits},
                                  {"seconds", l.solve.seconds}});
    json["stages"] = to_json_array(r.map.stages);
    json["capping"] = r.map.solve.capping;
    json["launches"] = r.map.counters.launches;
    json["waits"] = r.map.counters.waits;
    json["waits_of_solve"] = r.map.solve.waits;
    json["peak_memory_bytes"] = peak_memory();
    json["quality"] = to_json(r.after);
    json["notes"] = r.notes;
    return json;
}

std::string text_of(const unwrap_report& r, const unwrap_options& o)
{
    for (const auto& note : r.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    const auto& flips = r.after.quality.flips;
    const auto& s = r.map.solve;
    labelled_lines lines;
    lines.add("mesh",
              o.input + ": " + count(static_cast<std::uint64_t>(r.after.vertices), "vertex", "vertices") + ", " +
                  count(flips.elements, "triangle", "triangles") +
                  (r.seam_vertices > 0 ? ", " + count(r.seam_vertices, "vertex", "vertices") + " on seams" : ""));
    lines.add("device", r.device_label + ", " + to_string(r.map.precision));
    lines.add("start", (r.pins + r.springs > 0 ? "brought to the constraints" : describe_start(o)) + ": E " +
                           number(r.energy_before) + ", " + count(r.map.start.flips.flipped, "flip", "flips"));
    if (r.pins + r.springs > 0)
        lines.add("constraints",
                  count(r.pins, "vertex pinned", "vertices pinned") + ", " + count(r.springs, "spring", "springs"));
    const bool by_area = o.weights == energy::weighting::measure;
    const double other = by_area ? r.energy_end.uniform : r.energy_end.measure;
    lines.add("energy", to_string(o.energy) + ' ' + number(r.energy_before) + " -> " + number(r.energy, 6) +
                            (by_area ? " by area" : " mean") +
                            (r.after.measured ? (by_area ? ", mean " : ", by area ") + number(other, 6) : ""));
    if (const auto& overlap = r.map.overlap; overlap && overlap->before.pairs > 0)
        lines.add("overlap", count(overlap->before.pairs, "crossing", "crossings") + " of the boundary at E " +
                                 number(overlap->energy_before, 6) + ", none after " +
                                 count(static_cast<std::uint64_t>(overlap->rounds), "round", "rounds"));
    lines.add("stop", describe(s, o));
    lines.add("steps", count(static_cast<std::uint64_t>(s.iterations), "iteration", "iterations") + ", " +
                           count(static_cast<std::uint64_t>(s.evaluations), "evaluation", "evaluations") + ", " +
                           count(static_cast<std::uint64_t>(s.gradients), "gradient", "gradients"));
    describe_validity(lines, r.after);
    lines.add("time", duration(r.seconds.total) + ": read " + duration(r.seconds.read) + ", device " +
                          duration(r.seconds.queue + r.map.seconds.device) + ", setup " +
                          duration(r.map.seconds.setup) + ", hierarchy " + duration(r.map.seconds.hierarchy) +
                          ", start " + duration(r.map.seconds.start) +
                          (r.map.untangling.empty() ? "" : ", untangle " + duration(r.map.seconds.untangle)) +
                          ", solve " + duration(r.map.seconds.solve) +
                          (r.map.seconds.overlap > 0 ? ", overlap " + duration(r.map.seconds.overlap) : "") +
                          (r.seconds.draw > 0 ? ", draw " + duration(r.seconds.draw) : "") + ", write " +
                          duration(r.seconds.write));
    lines.add("memory", number(static_cast<double>(peak_memory()) / (1 << 20), 3) + " MiB at most");
    lines.add_written({o.output, o.picture, o.render, o.stats});
    std::ostringstream out;
    out << lines;
    print(out, r.after);
    return out.str();
}

} // namespace taut::tools
