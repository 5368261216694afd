// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
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
#include "shared_options.hpp"
#include "stages.hpp"
#include "text_table.hpp"
#include "volume/group_targets.hpp"
#include "volume/shape_options.hpp"
#include "volume/shape_report.hpp"
#include "volume/volume_case.hpp"
#include "volume/volume_drawing.hpp"
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

/// One run of `taut deform` or `taut smooth`.
template <class Element>
class shape_run
{
public:
    static constexpr int D = Element::dimension;

    shape_run(const shape_options& options, bool smoothing, run_clock clock, progress& progress,
              const char* place_of_report, const volume_case<Element>& input)
        : options_(options),
          smoothing_(smoothing),
          clock_(clock),
          progress_(progress),
          place_of_report_(place_of_report),
          input_(input),
          mesh_(input.simplices())
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
        group_targets targets(input_.file());
        for (const auto& name : options_.fixed) targets.fix(name);
        for (const auto& move : options_.moves) targets.move(move);
        if (smoothing_)
        {
            for (const auto& [v, x] : targets.all()) fixed_.push_back(v);
            return;
        }
        pins_ = constraints<Element>(mesh_);
        for (const auto& [v, x] : targets.all()) pins_.pin(v, vec<D>(x));
        if (!options_.pins.empty()) add_pins(pins_, io::read_pins<D>(options_.pins, mesh_.vertex_count()));
    }

    template <class Params>
    void limit(Params& params)
    {
        params.observer = [this](const taut::progress& p)
        {
            keep(p.usable);
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
        before_ = input_.look(input_.points());
        std::vector<vec<D>> x;
        solve_seconds_ = clock_.timed(
            [&]
            {
                if (smoothing_)
                {
                    smooth_params<Element> params{.boundary = options_.boundary,
                                                  .regular = input_.parts().regular,
                                                  .owners = input_.owners(),
                                                  .worst_exponent = options_.worst_exponent,
                                                  .fixed = fixed_};
                    limit(params);
                    auto r = smooth(q, mesh_, params);
                    x = std::move(r.x);
                    report_ = std::move(r.report);
                }
                else
                {
                    deform_params<Element> params{.energy = energy_of(options_.energy),
                                                  .constraints = pins_,
                                                  .owners = input_.owners(),
                                                  .initial = input_.points()};
                    if (input_.parts().overlapping) params.data.weights = input_.parts().weights;
                    limit(params);
                    auto r = deform(q, mesh_, params);
                    x = std::move(r.x);
                    report_ = std::move(r.report);
                }
            });
        keep(!x.empty());
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
        points_ = input_.in_file(x);
        after_ = input_.look(input_.as_written(x));
        bool held = true;
        if (report_.pins_held)
            for (const auto& [v, pin] : pins_.pins())
                for (int k = 0; k < D; ++k)
                    held = held && ((pin.held >> k & 1u) == 0 || x[static_cast<std::size_t>(v)][k] == pin.value[k]);
        valid_ = held && after_.simplices;
        if (valid_) return;
        code_ = exit_code::no_valid_map;
        report_.reason = held ? "in the single precision of the file the mesh has " +
                                    describe_defects<Element>(after_.simplices, input_.owners())
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
        auto files = io::volume_outputs(options_.output, input_.file(), points_);
        drawing_options drawing{options_.picture, options_.cut, smoothing_};
        if (drawn(drawing.path, report_.notes))
            files.push_back({drawing.path, [&](io::atomic_file& file) { file.write(picture(drawing)); }});
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

    std::string picture(const drawing_options& drawing) const
    {
        const std::string name = std::filesystem::path(options_.input).filename().string();
        const std::vector<vec<D>> x(points_.begin(), points_.end());
        return draw_states(input_.file(),
                           {state_to_draw(input_, name + ": before", input_.points(), smoothing_),
                            state_to_draw(input_, "after", x, smoothing_)},
                           drawing);
    }

    nlohmann::ordered_json json() const
    {
        nlohmann::ordered_json json;
        json["schema"] = smoothing_ ? "taut.smooth/1" : "taut.deform/1";
        json["input"] = options_.input;
        json["output"] = options_.output;
        json["format"] = input_.file().format;
        json["element"] = input_.element();
        json["vertices"] = mesh_.vertex_count();
        json["elements"] = input_.cells();
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
        json["inverted_start"] = before_.inverted.size();
        json["inverted"] = after_.inverted.size();
        json["branch_edges"] = D == 3 ? after_.simplices.branched : 0;
        json["branch_points"] = D == 2 ? after_.simplices.branched : 0;
        if (input_.parts().overlapping && D == 3) json["insides"] = insides_json(after_);
        json["quality_start"] = shapes_json(before_.shapes);
        json["quality"] = shapes_json(after_.shapes);
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
        lines.add("mesh", options_.input + ": " + count(mesh_.points().size(), "vertex", "vertices") + ", " +
                              count_cells(input_.file(), D) +
                              (smoothing_ ? "" : ", " + count(pins_.pins().size()) + " vertices held"));
        lines.add("device", device_);
        lines.add("inverted", count(before_.inverted.size()) + " -> " + count(after_.inverted.size()));
        if (input_.parts().overlapping && D == 3) lines.add("insides", insides_text(after_));
        lines.add("energy", number(report_.energy) + (report_.converged ? ", converged" : ", not converged") + ", " +
                                count(static_cast<std::uint64_t>(report_.steps), "step", "steps"));
        lines.add("before", shapes_text(before_.shapes));
        lines.add("after", shapes_text(after_.shapes));
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
    const volume_case<Element>& input_;
    const mesh<Element>& mesh_; ///< its simplices
    constraints<Element> pins_;
    std::vector<idx> fixed_;
    std::vector<vec3> points_;
    session_report report_;
    volume_state before_, after_;
    std::string device_;
    exit_code code_ = exit_code::valid;
    bool valid_ = false;
    double read_seconds_ = 0, device_seconds_ = 0, solve_seconds_ = 0, total_seconds_ = 0;
};

exit_code run(const shape_options& options, bool smoothing, std::chrono::steady_clock::time_point launch)
{
    outputs files;
    require_file(options.output);
    files.add("-o", options.output, {});
    files.add("--stats", options.stats, {".json"});
    files.add("--picture", options.picture, {".png", ".svg"});
    files.protect("the input", options.input);
    if (!options.pins.empty()) files.protect("the file of pins", options.pins);
    if (!options.rest.empty()) files.protect("the shape at rest", options.rest);
    const char* place_of_report = options.quiet ? nullptr : files.place_of_report();
    const run_clock clock(launch);
    limit_time(options.time_limit - clock.now());
    progress progress(progress_of(options.progress, options.quiet), std::cerr);
    progress.update({.phase = "read", .seconds = clock.now()});
    auto file = read_volume_at_rest(options.input, options.rest);
    if (smoothing) file.rest.clear();
    require_drawable(file, {options.picture, options.cut, smoothing});
    return with_case(file, [&]<class Element>(const volume_case<Element>& input)
                     { return shape_run<Element>(options, smoothing, clock, progress, place_of_report, input)(); });
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
    add_drawing(app, options.picture, options.cut, "Draw the mesh before and after");
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
