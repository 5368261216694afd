// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/energy/algebra.hpp>
#include <taut/energy/area.hpp>
#include <taut/energy/isometric.hpp>
#include <taut/energy/neo_hookean.hpp>
#include <taut/energy/shape.hpp>
#include <taut/io/make_untangle_problem.hpp>
#include <taut/io/pins.hpp>
#include <taut/io/read_volume.hpp>
#include <taut/io/write_files.hpp>
#include <taut/io/write_volume.hpp>
#include <taut/map/smooth.hpp>
#include <taut/measure/describe_defects.hpp>
#include <taut/measure/rigid_motion.hpp>

#include "assessment.hpp"
#include "choices.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "interrupt.hpp"
#include "open_queue.hpp"
#include "outputs.hpp"
#include "progress.hpp"
#include "run_clock.hpp"
#include "shape_options.hpp"
#include "shared_options.hpp"
#include "stages.hpp"
#include "text_table.hpp"
#include "writing.hpp"

namespace taut::tools
{

namespace
{

any_energy energy_of(shape_energy choice)
{
    switch (choice)
    {
    case shape_energy::shape:
        return energy::shape{};
    case shape_energy::volume:
        return 0.5 * energy::area{} + 0.5 * energy::isometric{};
    case shape_energy::neo_hookean:
        return energy::neo_hookean{};
    case shape_energy::isometric:
        break;
    }
    return energy::isometric{};
}

/// Numbers between commas; throws usage_error unless there are `count`.
std::vector<double> numbers_of(std::string_view text, std::size_t count, const std::string& option)
{
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        double x = 0;
        const auto [last, failure] = std::from_chars(text.data() + begin, text.data() + end, x);
        if (failure != std::errc{} || last != text.data() + end || !std::isfinite(x))
            throw usage_error("--move " + option + ": '" + std::string(text.substr(begin, end - begin)) +
                              "' is no number");
        numbers.push_back(x);
        begin = end + 1;
    }
    if (numbers.size() != count)
        throw usage_error("--move " + option + ": give " + std::to_string(count) + " numbers with commas between");
    return numbers;
}

/// Where the vertices of groups go, by vertex: each group by itself, and an error where two disagree.
class group_targets
{
public:
    explicit group_targets(const io::volume_file& file) : file_(file) {}

    void fix(const std::string& name)
    {
        for (const idx v : group(name).vertices) take(v, point(v), name);
    }

    /// GROUP=FILE.csv, GROUP:translate:x,y,z, GROUP:rotate:ax,ay,az,degrees or GROUP:scale:factor; about the middle of
    /// the group.
    void move(const std::string& text)
    {
        for (const auto& [word, count] : {std::pair{"translate", 3}, std::pair{"rotate", 4}, std::pair{"scale", 1}})
        {
            const std::string key = std::string(":") + word + ":";
            const auto at = text.rfind(key);
            if (at == text.npos) continue;
            const auto n =
                numbers_of(std::string_view(text).substr(at + key.size()), static_cast<std::size_t>(count), text);
            return transform(text.substr(0, at), count, n);
        }
        const auto at = text.rfind('=');
        if (at == text.npos)
            throw usage_error("--move " + text +
                              ": give GROUP=FILE.csv, GROUP:translate:x,y,z, "
                              "GROUP:rotate:ax,ay,az,degrees or GROUP:scale:factor");
        const std::string name = text.substr(0, at);
        const auto& members = group(name).vertices;
        for (const auto& p : io::read_pins<3>(text.substr(at + 1), static_cast<idx>(file_.points.size())))
        {
            if (!std::binary_search(members.begin(), members.end(), p.vertex))
                throw unsuitable_input(text.substr(at + 1) + ": vertex " + std::to_string(p.vertex) +
                                       " is not in group " + name);
            if (!p.hard() || p.held != constraints<tetrahedron>::all)
                throw unsuitable_input(text.substr(at + 1) + ": vertex " + std::to_string(p.vertex) +
                                       " has a weight or lacks a coordinate; use --pins for those");
            take(p.vertex, p.target, name);
        }
    }

    const std::map<idx, vec3>& all() const { return targets_; }

private:
    const io::volume_group& group(const std::string& name) const { return file_.find_group(name); }
    const vec3& point(idx v) const { return file_.points[static_cast<std::size_t>(v)]; }

    void transform(const std::string& name, int kind, const std::vector<double>& n)
    {
        const auto& members = group(name).vertices;
        vec3 middle(0.0);
        for (const idx v : members) middle += point(v) / static_cast<double>(members.size());
        rigid_motion<3> motion{.from = middle, .to = middle};
        if (kind == 4)
        {
            const vec3 axis(n[0], n[1], n[2]);
            if (!(glm::length(axis) > 0))
                throw usage_error("--move " + name + ": the axis of a rotation has no length");
            motion.axis = glm::normalize(axis);
            motion.angle = n[3] * std::numbers::pi / 180;
        }
        if (kind == 3) motion.to += vec3(n[0], n[1], n[2]);
        for (const idx v : members) take(v, kind == 1 ? middle + n[0] * (point(v) - middle) : motion(point(v)), name);
    }

    void take(idx v, const vec3& x, const std::string& name)
    {
        const auto [at, is_new] = targets_.try_emplace(v, x);
        if (!is_new && at->second != x)
            throw unsuitable_input("vertex " + std::to_string(v) + " is in " + owner_[v] + " and in " + name +
                                   ", which go different ways; leave it to one of them");
        owner_[v] = name;
    }

    const io::volume_file& file_;
    std::map<idx, vec3> targets_;
    std::map<idx, std::string> owner_;
};

nlohmann::ordered_json to_json(const shape_quality& q)
{
    return {{"mean_ratio", {{"worst", q.worst.mean_ratio}, {"mean", q.mean_ratio}}},
            {"scaled_jacobian", {{"worst", q.worst.scaled_jacobian}, {"mean", q.scaled_jacobian}}},
            {"angle", {{"least", q.worst.min_angle}, {"most", q.worst.max_angle}}},
            {"worst_ids", q.worst_ids}};
}

std::string text_of(const shape_quality& q)
{
    return "mean ratio " + number(q.worst.mean_ratio) + " worst, " + number(q.mean_ratio) + " mean; angles " +
           number(q.worst.min_angle) + " to " + number(q.worst.max_angle) + " degrees";
}

/// One run of `taut deform` or `taut smooth`.
template <class Element>
class shape_run
{
public:
    static constexpr int D = Element::dimension;

    shape_run(const shape_options& options, bool smoothing, run_clock clock, progress& progress,
              const char* place_of_report, const io::volume_file& file, mesh<Element> m)
        : options_(options),
          smoothing_(smoothing),
          clock_(clock),
          progress_(progress),
          place_of_report_(place_of_report),
          file_(file),
          mesh_(std::move(m))
    {
        read_seconds_ = clock_.now();
    }

    exit_code operator()()
    {
        prepare();
        tell("device");
        std::optional<queue> q;
        device_seconds_ = clock_.timed([&] { q = open_queue(options_.device, false); });
        device_ = q->device().name();
        tell(smoothing_ ? "smooth" : "deform");
        solve(*q);
        if (!valid_) refuse();
        write();
        return code_;
    }

private:
    void tell(std::string_view phase) { progress_.update({.phase = phase, .seconds = clock_.now()}); }

    void prepare()
    {
        group_targets targets(file_);
        for (const auto& name : options_.fixed) targets.fix(name);
        for (const auto& move : options_.moves) targets.move(move);
        if (smoothing_)
        {
            for (const auto& [v, x] : targets.all()) fixed_.push_back(v);
            return;
        }
        pins_ = constraints<Element>(mesh_);
        for (const auto& [v, x] : targets.all()) pins_.pin(v, vec<D>(x));
        if (!options_.pins.empty())
            add_pins(pins_, io::read_pins<D>(options_.pins, static_cast<idx>(file_.points.size())));
        if (options_.rest.empty()) return;
        const auto rest = io::read_volume_file(options_.rest);
        if (rest.points.size() != file_.points.size())
            throw unsuitable_input(options_.rest + " has " + count(rest.points.size(), "point", "points") + ", not " +
                                   count(file_.points.size()) + " as " + options_.input);
        rest_ = rest.points;
    }

    template <class Params>
    void limit(Params& params)
    {
        params.observer = [this](const taut::progress& p)
        {
            if (p.iterate)
                progress_.update({.phase = smoothing_ ? "smooth" : "deform",
                                  .step = p.iteration,
                                  .energy = p.value,
                                  .gradient = p.gradient,
                                  .seconds = clock_.now()});
            return !interrupted();
        };
        if (std::isfinite(options_.time_limit))
            params.time_limit = std::chrono::duration<double>(std::max(1e-6, options_.time_limit - clock_.now()));
    }

    void solve(queue& q)
    {
        const std::vector<vec<D>> start(mesh_.points().begin(), mesh_.points().end());
        before_ = measure_shapes<Element>(mesh_.cells(), std::span<const vec<D>>(start));
        inverted_before_ = certify<D>(mesh_.cells(), std::span<const vec<D>>(start)).flipped;
        std::vector<vec<D>> x;
        solve_seconds_ = clock_.timed(
            [&]
            {
                if (smoothing_)
                {
                    smooth_params<Element> params{
                        .boundary = options_.boundary, .worst_exponent = options_.worst_exponent, .fixed = fixed_};
                    limit(params);
                    auto r = smooth(q, mesh_, params);
                    x = std::move(r.x);
                    report_ = std::move(r.report);
                }
                else
                {
                    deform_params<Element> params{
                        .energy = energy_of(options_.energy), .constraints = pins_, .rest = rest_};
                    limit(params);
                    auto r = deform(q, mesh_, params);
                    x = std::move(r.x);
                    report_ = std::move(r.report);
                }
            });
        take(std::move(x));
    }

    /// The certificate of exactly what is written, and the pins bit for bit, not taken from the solver's word.
    void take(std::vector<vec<D>> x)
    {
        code_ = interrupted()                            ? interruption()
                : report_.outcome == outcome::valid      ? exit_code::valid
                : report_.outcome == outcome::stopped    ? exit_code::time_limit
                : report_.outcome == outcome::infeasible ? exit_code::infeasible
                                                         : exit_code::no_valid_map;
        if (x.empty() || code_ == exit_code::infeasible || code_ == exit_code::no_valid_map) return;
        points_ = file_.points;
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int k = 0; k < D; ++k) points_[v][k] = x[v][k];
        const auto kept = io::rounded_to_file(file_, points_);
        std::vector<vec<D>> written(kept.begin(), kept.end());
        after_ = certify<D>(mesh_.cells(), std::span<const vec<D>>(written));
        shapes_ = measure_shapes<Element>(mesh_.cells(), std::span<const vec<D>>(written));
        bool held = true;
        if (report_.pins_held)
            for (const auto& [v, pin] : pins_.pins())
                for (int k = 0; k < D; ++k)
                    held = held && ((pin.held >> k & 1u) == 0 || x[static_cast<std::size_t>(v)][k] == pin.value[k]);
        valid_ = held && after_;
        if (valid_) return;
        code_ = exit_code::no_valid_map;
        report_.reason = held ? "in the single precision of the file the mesh has " + describe_defects<Element>(after_)
                              : "a pin has moved";
    }

    [[noreturn]] void refuse() const
    {
        progress_.finish();
        if (code_ == exit_code::infeasible) throw infeasible_problem(report_.reason);
        if (interrupted()) throw interrupted_run("there was no mesh to write yet");
        throw no_valid_map(report_.reason.empty() ? "nothing was written" : report_.reason);
    }

    void write()
    {
        tell("write");
        const auto note_time = [&] { total_seconds_ = clock_.now(); };
        auto files = io::volume_outputs(options_.output, file_, points_);
        if (!options_.stats.empty())
            files.push_back(
                {options_.stats, [&](io::atomic_file& file)
                 {
                     note_time();
                     file.write(json().dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
                 }});
        if (place_of_report_ && has_reader(place_of_report_))
            files.push_back({place_of_report_, [&](io::atomic_file& file)
                             {
                                 note_time();
                                 progress_.finish();
                                 file.write(text());
                             }});
        writing([&] { io::write_files(files); });
        progress_.finish();
    }

    nlohmann::ordered_json json() const
    {
        nlohmann::ordered_json json;
        json["schema"] = smoothing_ ? "taut.smooth/1" : "taut.deform/1";
        json["input"] = options_.input;
        json["output"] = options_.output;
        json["format"] = file_.format;
        json["element"] = Element::name;
        json["vertices"] = file_.points.size();
        json["elements"] = mesh_.cells().size();
        json["pins"] = pins_.pins().size();
        json["springs"] = pins_.springs().size();
        json["device"] = device_;
        json["outcome"] = report_.pins_held || report_.outcome == outcome::valid ? "valid" : "stopped";
        json["reason"] = report_.reason;
        json["converged"] = report_.converged;
        json["pins_held"] = report_.pins_held;
        json["farthest"] = report_.farthest;
        json["distance"] = report_.distance;
        json["energy"] = finite(report_.energy);
        json["gradient"] = finite(report_.gradient);
        json["iterations"] = report_.steps;
        json["inverted_start"] = inverted_before_;
        json["inverted"] = after_.flipped;
        json["branch_edges"] = D == 3 ? after_.branched : 0;
        json["branch_points"] = D == 2 ? after_.branched : 0;
        json["quality_start"] = to_json(before_);
        json["quality"] = to_json(shapes_);
        const auto& s = report_.seconds;
        json["seconds"] = {{"read", read_seconds_},  {"device", device_seconds_}, {"start", s.start},
                           {"follow", s.follow},     {"repair", s.repair},        {"solve", s.solve},
                           {"total", total_seconds_}};
        json["stages"] = to_json_array(report_.stages);
        json["peak_memory_bytes"] = peak_memory();
        json["notes"] = report_.notes;
        return json;
    }

    std::string text() const
    {
        for (const auto& note : report_.notes) std::cerr << "taut: note: " << note << '\n';
        if (!report_.pins_held && !report_.reason.empty()) std::cerr << "taut: note: " << report_.reason << '\n';
        labelled_lines lines;
        lines.add("mesh", options_.input + ": " + count(file_.points.size(), "vertex", "vertices") + ", " +
                              count(mesh_.cells().size()) + ' ' + Element::names +
                              (smoothing_ ? "" : ", " + count(pins_.pins().size()) + " vertices held"));
        lines.add("device", device_);
        lines.add("inverted", count(inverted_before_) + " -> " + count(after_.flipped));
        lines.add("energy", number(report_.energy) + (report_.converged ? ", converged" : ", not converged") + ", " +
                                count(static_cast<std::uint64_t>(report_.steps), "step", "steps"));
        lines.add("before", text_of(before_));
        lines.add("after", text_of(shapes_));
        lines.add("time", duration(total_seconds_) + ": read " + duration(read_seconds_) + ", device " +
                              duration(device_seconds_) + ", solve " + duration(solve_seconds_));
        lines.add("wrote", options_.output + (options_.stats.empty() ? "" : ", " + options_.stats));
        return (std::ostringstream() << lines).str();
    }

    const shape_options& options_;
    bool smoothing_;
    run_clock clock_;
    progress& progress_;
    const char* place_of_report_; ///< null: there is none
    const io::volume_file& file_;
    mesh<Element> mesh_;
    constraints<Element> pins_;
    std::vector<idx> fixed_;
    std::vector<vec3> rest_, points_;
    session_report report_;
    shape_quality before_, shapes_;
    certificate after_;
    std::size_t inverted_before_ = 0;
    std::string device_;
    exit_code code_ = exit_code::valid;
    bool valid_ = false;
    double read_seconds_ = 0, device_seconds_ = 0, solve_seconds_ = 0, total_seconds_ = 0;
};

exit_code run(const shape_options& options, bool smoothing, std::chrono::steady_clock::time_point launch)
{
    outputs files;
    files.add("-o", options.output, {});
    files.add("--stats", options.stats, {".json"});
    files.protect("the input", options.input);
    if (!options.pins.empty()) files.protect("the file of pins", options.pins);
    if (!options.rest.empty()) files.protect("the shape at rest", options.rest);
    const char* place_of_report = options.quiet ? nullptr : files.place_of_report();
    const run_clock clock(launch);
    limit_time(options.time_limit - clock.now());
    progress progress(progress_of(options.progress, options.quiet), std::cerr);
    progress.update({.phase = "read", .seconds = clock.now()});
    const auto file = io::read_volume_file(options.input);
    if (file.dimension == 2)
        return shape_run<triangle>(options, smoothing, clock, progress, place_of_report, file,
                                   io::triangles_of(file))();
    return shape_run<tetrahedron>(options, smoothing, clock, progress, place_of_report, file,
                                  io::tetrahedra_of(file))();
}

/// What both commands have.
CLI::App& add_shape_command(CLI::App& program, const char* name, const char* what, shape_options& options)
{
    auto& app = *program.add_subcommand(name, what);
    app.add_option("MESH", options.input,
                   "Tetrahedra, or triangles of the plane: .mesh .msh .vtk .vtu .node .su2 .prob")
        ->required()
        ->type_name("FILE");
    app.add_option("-o,--output", options.output,
                   "Mesh to write, in the format of the input: the same file with other coordinates")
        ->required()
        ->type_name("OUT");
    app.add_option("--fix", options.fixed, "Keep the vertices of a group where they are; more than once, if need be")
        ->type_name("GROUP");
    add_time_limit(app, options.time_limit, "Stop after S seconds, with the best mesh by then");
    add_device(app, options.device);
    add_path(app, "--stats", options.stats, standard_output, "Write numbers as JSON")->type_name("FILE.json");
    add_progress(app, options.progress, options.quiet);
    app.footer("exit codes: 0 valid mesh; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
               "  6 none was found; 7 proved infeasible; 8 time limit, with the best mesh written; 9 device failure;\n"
               "  130 interrupted, 143 terminated");
    return app;
}

} // namespace

command add_deform(CLI::App& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<shape_options>();
    auto& app = add_shape_command(program, "deform",
                                  "Deform a volume, or a mesh of the plane, by what is held and moved", *options);
    app.add_option("--pins", options->pins, "Vertices to hold or draw: vertex,x,y,z[,weight], vertices from 0")
        ->type_name("FILE.csv");
    app.add_option("--move", options->moves,
                   "Move a group: GROUP=FILE.csv (vertex,x,y,z), GROUP:translate:x,y,z, GROUP:rotate:ax,ay,az,degrees "
                   "or GROUP:scale:factor, about its middle")
        ->type_name("MOVE");
    app.add_option("--rest", options->rest, "The mesh at rest, if the input is not: the same vertices and cells")
        ->type_name("FILE");
    add_choice(app, "--energy", options->energy,
               std::vector<choice<shape_energy>>{{"isometric", shape_energy::isometric},
                                                 {"shape", shape_energy::shape},
                                                 {"volume", shape_energy::volume},
                                                 {"neo-hookean", shape_energy::neo_hookean}},
               "What to keep: lengths, angles, volumes and lengths, or as rubber does");
    return [options, launch] { return run(*options, false, launch); };
}

command add_smooth(CLI::App& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<shape_options>();
    auto& app = add_shape_command(program, "smooth", "Move vertices to where the elements are best shaped", *options);
    add_choice(app, "--boundary", options->boundary,
               std::vector<choice<smooth_boundary>>{{"sliding", smooth_boundary::sliding},
                                                    {"fixed", smooth_boundary::fixed},
                                                    {"free", smooth_boundary::free}},
               "What the boundary may do");
    app.add_option("--worst", options->worst_exponent, "Exponent of the energy: 1 the mean counts, more: the worst")
        ->type_name("1..8")
        ->check(CLI::Range(1, 8));
    return [options, launch] { return run(*options, true, launch); };
}

} // namespace taut::tools
