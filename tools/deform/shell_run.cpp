// SPDX-License-Identifier: MIT
#include "deform/shell_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include <picture/render_picture.hpp>
#include <taut/certify.hpp>
#include <taut/deform.hpp>
#include <taut/files.hpp>
#include <taut/impl/core/exact/collapses.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/files/file/atomic_file_bodies.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#include "shared/assessment.hpp"
#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/peak_memory.hpp"
#include "shared/printable.hpp"
#include "shared/stages.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

shell_run::shell_run(const shape_options& options, command_run& run) : options_(options), command_(run)
{
    const auto refuse = [](bool given, const char* option)
    {
        if (given)
            throw usage_error(std::string(option) +
                              " is for volumes and planar meshes, not for surfaces in space; leave it out");
    };
    refuse(!options.clip.empty(), "--clip");
    refuse(!options.moves.empty(), "--move");
    refuse(!options.fixed.empty(), "--fix");
    refuse(options.energy != shape_energy::isometric, "--energy");
    if (!io::impl::is_stream(options.output) && extension(options.output) != ".obj")
        throw usage_error("-o: a surface is written as .obj; name it so");
    if (!options.picture.empty() && extension(options.picture) != ".png")
        throw usage_error("--picture: a surface is drawn as .png; name it so");
}

exit_code shell_run::operator()()
{
    const auto file = io::read_surface_file(options_.input);
    const auto rest = options_.rest.empty() ? file.surface : shape_at_rest(file.surface);
    const thin_shell shell(rest);
    auto pins = taut::constraints(shell.hinges());
    std::vector<io::pin<3>> read;
    if (!options_.pins.empty()) read = io::read_pins<3>(options_.pins, file.surface.vertex_count());
    pins.add(read);
    pins.require_used(impl::unused_vertices(rest.points().size(), rest.cells()));
    vertices_ = file.surface.points().size();
    triangles_ = file.surface.cells().size();
    pins_ = pins.pins().size();
    springs_ = pins.springs().size();
    read_ = command_.clock.now();
    command_.tell("device");
    auto q = open_queue(options_.device, false);
    device_ = q.device().name();
    command_.tell("deform");
    std::optional<session_result<hinge>> found;
    auto wanted = params(shell, pins);
    if (!options_.rest.empty()) wanted.initial = file.surface.points();
    solve_ = command_.clock.timed([&] { found = deform(q, shell, wanted, limits()); });
    take(*found, rest, pins);
    if (points_.empty()) refuse();
    run_.notes.insert(run_.notes.begin(), file.notes.begin(), file.notes.end());
    if (!options_.pins.empty() && read.empty()) run_.notes.push_back(options_.pins + no_pins);
    if (pins_ + springs_ == 0) run_.notes.emplace_back(nothing_held);
    write(file, rest);
    return code_;
}

mesh<triangle> shell_run::shape_at_rest(const mesh<triangle>& surface) const
{
    auto rest = io::read_surface_file(options_.rest).surface;
    if (rest.cells() != surface.cells() || rest.vertex_count() != surface.vertex_count())
        throw unsuitable_input(options_.rest + " has other triangles or vertices than " + options_.input +
                               "; the shape at rest differs in coordinates alone");
    return rest;
}

shell_params shell_run::params(const thin_shell& shell, const constraints<hinge>& pins)
{
    thickness_ = options_.thickness.value_or(shell.mean_edge());
    shell_params p{.constraints = pins, .thickness = thickness_};
    if (options_.tolerance) p.solve.gradient_tolerance = *options_.tolerance;
    return p;
}

run_limits shell_run::limits()
{
    return {command_.clock.left(options_.time_limit), [this](const taut::progress& at)
            {
                keep(at.usable);
                if (at.iterate)
                    command_.tell(
                        {.phase = "deform", .step = at.iteration, .energy = at.value, .gradient = at.gradient});
                return !interrupted();
            }};
}

/// The certificate of exactly what is written, and the pins bit for bit, not taken from the solver's word.
void shell_run::take(const session_result<hinge>& found, const mesh<triangle>& surface, const constraints<hinge>& pins)
{
    run_ = found.report;
    const bool late = run_.outcome == outcome::stopped || (run_.outcome == outcome::valid && run_.stopped);
    code_ = interrupted()                    ? interruption()
            : late                           ? exit_code::time_limit
            : run_.outcome == outcome::valid ? exit_code::valid
                                             : exit_code::no_valid_map;
    if (code_ == exit_code::no_valid_map || found.x.empty()) return;
    bool held = true;
    if (run_.pins_held)
        for (const auto& [v, pin] : pins.pins())
            for (int k = 0; k < 3; ++k)
                held = held && ((pin.held >> k & 1u) == 0 || found.x[static_cast<std::size_t>(v)][k] == pin.value[k]);
    run_.flips = impl::certify_surface(surface.cells(), surface.points(), found.x);
    if (held && run_.flips)
    {
        points_ = found.x;
        edges_ = changes(surface);
        return;
    }
    code_ = exit_code::no_valid_map;
    run_.reason = held ? impl::describe_defects<hinge>(run_.flips) : "a pin has moved";
}

void shell_run::refuse() const
{
    command_.finish();
    if (interrupted()) throw interrupted_run("there was no surface to write yet");
    throw no_valid_map(run_.reason.empty() ? "nothing was written" : run_.reason);
}

void shell_run::write(const io::surface_file& file, const mesh<triangle>& rest)
{
    std::vector<io::file_to_write> files{{options_.output, [&](io::atomic_file& out) { file.write(out, points_); }}};
    if (!options_.picture.empty())
        files.push_back({options_.picture, [&](io::atomic_file& out) { out.write(picture(rest)); }});
    command_.write(std::move(files), *this, options_, [&](double total, double) { total_ = total; });
}

/// The surface at rest, and below as it is now, both seen from the same sides.
std::string shell_run::picture(const mesh<triangle>& rest) const
{
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const std::vector<vec2> no_map(points_.size(), vec2(none));
    const auto seen = io::guess_orientation(rest.points(), rest.cells());
    const auto draw = [&](const std::vector<vec3>& points, const std::string& title)
    { return io::render_picture(points, rest.cells(), no_map, {.title = title, .up = seen.up, .front = seen.front}); };
    const auto before = draw(rest.points(), options_.input + " at rest"), after = draw(points_, "deformed");
    io::image both(before.width(), 2 * before.height());
    const auto middle = std::copy(before.pixels().begin(), before.pixels().end(), both.pixels().begin());
    std::copy(after.pixels().begin(), after.pixels().end(), middle);
    return encode_png(both);
}

shell_run::edge_changes shell_run::changes(const mesh<triangle>& surface) const
{
    edge_changes found;
    const auto& rest = surface.points();
    for (const auto& t : surface.cells())
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto a = static_cast<std::size_t>(t[k]), b = static_cast<std::size_t>(t[(k + 1) % 3]);
            const double change = glm::distance(points_[a], points_[b]) / glm::distance(rest[a], rest[b]) - 1;
            found.mean_square += change * change;
            found.largest = std::max(found.largest, std::abs(change));
        }
    found.mean_square = std::sqrt(found.mean_square / (3.0 * static_cast<double>(surface.cells().size())));
    return found;
}

nlohmann::ordered_json shell_run::json() const
{
    nlohmann::ordered_json json;
    json["schema"] = "taut.deform/1";
    json["input"] = options_.input;
    json["output"] = options_.output;
    json["element"] = "shell";
    json["vertices"] = vertices_;
    json["elements"] = triangles_;
    json["pins"] = pins_;
    json["springs"] = springs_;
    json["thickness"] = thickness_;
    json["device"] = device_;
    json["outcome"] = run_.pins_held || run_.outcome == outcome::valid ? "valid" : "stopped";
    json["reason"] = run_.reason;
    json["converged"] = run_.converged;
    json["pins_held"] = run_.pins_held;
    json["farthest"] = run_.farthest;
    json["distance"] = run_.distance;
    json["energy"] = finite(run_.energy);
    json["gradient"] = finite(run_.gradient);
    json["iterations"] = run_.steps;
    json["collapsed"] = run_.flips.flipped;
    json["area_ratio"] = {{"min", finite(run_.flips.min_det)}, {"max", finite(run_.flips.max_det)}};
    json["edge_change"] = {{"rms", finite(edges_.mean_square)}, {"max", finite(edges_.largest)}};
    json["seconds"] = {{"read", read_},
                       {"start", run_.seconds.start},
                       {"follow", run_.seconds.follow},
                       {"solve", run_.seconds.solve},
                       {"total", total_}};
    json["stages"] = to_json_array(run_.stages);
    json["peak_memory_bytes"] = peak_memory();
    json["notes"] = run_.notes;
    return json;
}

std::string shell_run::text() const
{
    for (const auto& note : run_.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    if (!run_.pins_held && !run_.reason.empty()) std::cerr << "taut: note: " << printable(run_.reason) << '\n';
    labelled_lines lines;
    lines.add("surface", options_.input + ": " + count(vertices_, "vertex", "vertices") + ", " +
                             count(triangles_, "triangle", "triangles") + ", " + count(pins_) + " vertices held");
    lines.add("device", device_);
    lines.add("energy", number(run_.energy) + (run_.converged ? ", converged" : ", not converged") + ", " +
                            count(static_cast<std::uint64_t>(run_.steps), "step", "steps") + ", thickness " +
                            number(thickness_));
    lines.add("edges", "change by " + number(100 * edges_.mean_square) + " % (root mean square), at most " +
                           number(100 * edges_.largest) + " %");
    lines.add("areas", number(run_.flips.min_det) + " .. " + number(run_.flips.max_det) + " of those at rest");
    lines.add("time", duration(total_) + ": read " + duration(read_) + ", solve " + duration(solve_));
    lines.add_written({options_.output, options_.picture, options_.stats});
    return (std::ostringstream() << lines).str();
}

} // namespace taut::tools
