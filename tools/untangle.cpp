// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <picture/layout_picture.hpp>
#include <picture/layout_svg.hpp>
#include <picture/side_by_side_svg.hpp>
#include <picture/symmetric_distortion.hpp>
#include <taut/io/make_untangle_problem.hpp>
#include <taut/io/write_files.hpp>
#include <taut/io/write_map.hpp>
#include <taut/measure/describe_defects.hpp>
#include <taut/untangle/proofs/infeasible.hpp>
#include <taut/untangle/untangle.hpp>

#include "choices.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "interrupt.hpp"
#include "open_queue.hpp"
#include "outputs.hpp"
#include "png.hpp"
#include "progress.hpp"
#include "run_clock.hpp"
#include "shared_options.hpp"
#include "text_table.hpp"
#include "untangle_report.hpp"
#include "volume/volume_drawing.hpp"
#include "volume/volume_problem.hpp"
#include "writing.hpp"

namespace taut::tools
{

namespace
{

/// One picture of a map in the plane with its pins.
struct layout_input
{
    std::span<const vec2> x;
    io::layout_style style;
};

io::layout_overlay overlay_of(const untangle_problem<triangle>& p, std::span<const vec2> x)
{
    io::layout_overlay overlay;
    for (const idx v : branch_points(p.rest.cells(), x))
        overlay.branch_points.push_back(x[static_cast<std::size_t>(v)]);
    for (std::size_t v = 0; v < x.size(); ++v)
        if (p.held.any(v)) overlay.pins.push_back({x[v], x[v], true, p.held[v]});
    return overlay;
}

/// The boundary edges as loops of their own: a mesh to untangle need not be a manifold.
std::vector<std::vector<idx>> outline_of(const mesh<triangle>& m)
{
    std::vector<std::vector<idx>> edges;
    for (const auto& [a, b] : boundary_facets(m)) edges.push_back({a, b});
    return edges;
}

/// The bytes of a picture; SVG or PNG as the path says.
std::string draw(const std::string& path, const untangle_problem<triangle>& p, const std::vector<layout_input>& maps)
{
    constexpr int gap = 24;
    const auto& cells = p.rest.cells();
    const auto outline = outline_of(p.rest);
    std::vector<std::string> texts;
    std::vector<io::image> images;
    for (const auto& [x, style] : maps)
    {
        const auto distortion = io::symmetric_distortion(p.rest.points(), cells, x);
        const auto overlay = overlay_of(p, x);
        if (extension(path) == ".svg")
            texts.push_back(io::layout_svg(x, cells, distortion, outline, style, overlay));
        else
            images.push_back(io::layout_picture(x, cells, distortion, outline, style, overlay));
    }
    const io::layout_style size;
    if (extension(path) == ".svg") return io::side_by_side_svg(texts, size.width, size.height, gap);
    return encode_png(io::side_by_side(images, gap));
}

/// One run of `taut untangle`, phase by phase.
template <class Element>
class untangle_run
{
public:
    static constexpr int D = Element::dimension;

    /// input: the volume file that the problem is of, if it is of one.
    untangle_run(const untangle_options& options, run_clock clock, progress& progress, untangle_report report,
                 const char* place_of_report, const volume_case<Element>* input)
        : options_(options),
          input_(input),
          clock_(clock),
          progress_(progress),
          report_(std::move(report)),
          place_of_report_(place_of_report)
    {
    }

    exit_code operator()(untangle_problem<Element> problem)
    {
        problem_.emplace(std::move(problem));
        report_.dimension = D;
        report_.vertices = problem_->initial.size();
        report_.pinned = problem_->held.count();
        if (input_)
        {
            report_.format = input_->file().format;
            report_.element = input_->element();
            report_.elements = input_->cells();
            report_.cells = count_cells(input_->file(), D);
        }
        else
        {
            report_.element = Element::name;
            report_.elements = problem_->rest.cells().size();
            report_.cells = count(report_.elements, Element::name, Element::names);
        }
        report_.before = certified(problem_->initial, report_.state_before);
        if (!prove_infeasible()) solve();
        write();
        if (report_.code == exit_code::infeasible) throw infeasible_problem(report_.reason);
        if (valid_) return report_.code;
        const std::string why =
            report_.reason + (report_.written.empty() ? "" : "; the best map is in " + report_.written);
        if (interrupted()) throw interrupted_run(why);
        throw no_valid_map(why);
    }

private:
    void tell(std::string_view phase) { progress_.update({.phase = phase, .seconds = clock_.now()}); }

    /// Of what a reader of the file will have.
    certificate certified(const std::vector<vec<D>>& x, volume_state& state) const
    {
        if (!input_) return certify<D>(problem_->rest.cells(), std::span<const vec<D>>(x));
        state = input_->look(input_->as_written(x));
        auto found = state.simplices;
        found.flipped = state.inverted.size();
        return found;
    }

    /// Proofs need no device and no time, so they come first, and all of them are told.
    bool prove_infeasible()
    {
        tell("check");
        infeasibility found;
        report_.seconds.check = clock_.timed([&] { found = find_infeasibility(*problem_); });
        for (const auto& warning : found.warnings) report_.notes.push_back(warning.message);
        if (!found) return false;
        report_.code = exit_code::infeasible;
        report_.outcome = "infeasible";
        report_.after = report_.before;
        report_.ids = found.proofs.front().ids;
        for (const auto& proof : found.proofs) report_.reason += (report_.reason.empty() ? "" : "\n  ") + proof.message;
        return true;
    }

    void solve()
    {
        tell("device");
        std::optional<queue> q;
        report_.seconds.device = clock_.timed([&] { q = open_queue(options_.device, false); });
        report_.device = q->device().name();
        report_.device_label = (std::ostringstream() << q->device()).str();

        untangle_params params;
        params.observer = [this](const taut::progress& p)
        {
            if (p.iterate)
                progress_.update(
                    {.phase = "untangle", .step = p.iteration, .inverted = p.value, .seconds = clock_.now()});
            return !interrupted();
        };
        // The limit is one for the whole run: what reading took is gone.
        if (std::isfinite(options_.time_limit))
            params.time_limit = std::chrono::duration<double>(std::max(1e-6, options_.time_limit - clock_.now()));
        tell("untangle");
        keep(true); // the initial map, at least
        untangle_result<Element> result;
        report_.seconds.solve = clock_.timed([&] { result = untangle(*q, *problem_, params); });
        take(std::move(result));
    }

    void take(untangle_result<Element> result)
    {
        // The certificate of exactly what is written, and the pins bit for bit, not taken from the solver's word.
        report_.after = certified(result.map, report_.state_after);
        bool held = true;
        for (std::size_t v = 0; v < problem_->held.size(); ++v)
            for (int k = 0; k < D; ++k)
                held = held && (!problem_->held.test(v, k) || result.map[v][k] == problem_->initial[v][k]);
        const bool valid = held && report_.after;
        report_.outcome = valid ? "injective" : interrupted() ? "interrupted" : "gave_up";
        report_.code = interrupted() ? interruption() : valid ? exit_code::valid : exit_code::no_valid_map;
        report_.reason = valid    ? ""
                         : !held  ? "a pin has moved"
                         : result ? "in the single precision of the file there is " +
                                        describe_defects<Element>(report_.after, problem_->owners)
                                  : result.reason;
        report_.ids = std::move(result.ids);
        report_.least_det = result.flips.min_det;
        report_.least_relative_det = result.least_relative_det;
        report_.stage = std::move(result.stage);
        report_.stages = std::move(result.stages);
        valid_ = valid;
        map_ = std::move(result.map);
    }

    /// All files appear together, so the report comes before them: where it cannot be printed, nothing has changed.
    void write()
    {
        tell("write");
        const double begin = clock_.now();
        const auto note_time = [&]
        {
            report_.seconds.total = clock_.now();
            report_.seconds.write = report_.seconds.total - begin;
        };
        std::vector<io::file_to_write> files;
        // A map with defects never gets the name that was asked for.
        if (!map_.empty()) report_.written = valid_ ? options_.output : name_of_invalid(options_.output);
        const auto points = input_ && !map_.empty() ? input_->in_file(map_) : std::vector<vec3>();
        if (input_ && valid_)
            files = io::volume_outputs(report_.written, input_->file(), points);
        else if (!report_.written.empty())
            files.push_back({report_.written, [&](io::atomic_file& file)
                             {
                                 if (input_)
                                     file.write(io::with_points(input_->file(), points));
                                 else
                                     io::write_map<D>(file, map_);
                             }});
        if (drawn(options_.picture, report_.notes))
            files.push_back({options_.picture, [&](io::atomic_file& file) { file.write(picture()); }});
        if (!options_.stats.empty())
            files.push_back({options_.stats, [&](io::atomic_file& file)
                             {
                                 note_time();
                                 file.write(to_json(report_, options_).dump(2, ' ', false, replace) + '\n');
                             }});
        if (place_of_report_ && has_reader(place_of_report_))
            files.push_back({place_of_report_, [&](io::atomic_file& file)
                             {
                                 note_time();
                                 progress_.finish();
                                 file.write(text_of(report_, options_));
                             }});
        writing([&] { io::write_files(files); });
        progress_.finish();
        if (valid_) remove_invalid(options_.output);
    }

    std::string picture() const
    {
        const std::string name = std::filesystem::path(options_.input).filename().string();
        if (!input_)
        {
            if constexpr (D == 2) return picture_of_problem(name);
            return {};
        }
        const bool by_shape = input_->file().rest.empty();
        std::vector<drawn_state> states{state_to_draw(*input_, name + ": before", problem_->initial, by_shape)};
        if (!map_.empty()) states.push_back(state_to_draw(*input_, "after: " + report_.outcome, map_, by_shape));
        return draw_states(input_->file(), states, {options_.picture, options_.cut, by_shape});
    }

    std::string picture_of_problem(const std::string& name) const requires(D == 2)
    {
        std::vector<layout_input> maps{
            {problem_->initial, {.title = name + ": before", .note = count(report_.pinned) + " vertices pinned"}}};
        if (!map_.empty())
            maps.push_back(
                {map_, {.title = "after", .note = report_.outcome + (valid_ ? " by " + report_.stage : "")}});
        else
            maps.back().style.note += ", infeasible";
        return draw(options_.picture, *problem_, maps);
    }

    static constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace; // file names need not be UTF-8

    untangle_options options_;
    const volume_case<Element>* input_; ///< null: there is none
    run_clock clock_;
    progress& progress_;
    untangle_report report_;
    const char* place_of_report_; ///< null: there is none
    std::optional<untangle_problem<Element>> problem_;
    std::vector<vec<D>> map_;
    bool valid_ = false;
};

/// Throws usage_error where there is an option that problems have no use for.
void require_problem_options(const untangle_options& options)
{
    const auto refuse = [](const char* option, bool given)
    {
        if (given) throw usage_error(std::string(option) + " is of volume files; a problem says it itself");
    };
    refuse("--rest", !options.rest.empty());
    refuse("--pins", !options.pins.empty());
    refuse("--fix", !options.fixed.empty());
    refuse("--cut", !options.cut.empty());
    refuse("--boundary", options.boundary != untangle_boundary::automatic);
}

exit_code run(const untangle_options& options, std::chrono::steady_clock::time_point launch)
{
    const bool volume = names_volume(options.input);
    if (!volume) require_problem_options(options);
    outputs files;
    if (volume) require_file(options.output);
    files.add("-o", options.output, {});
    files.add("-o (not valid)", name_of_invalid(options.output), {});
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
    untangle_report report;
    const auto untangled =
        [&]<class Element>(untangle_problem<Element> problem, const volume_case<Element>* input = nullptr)
    {
        return untangle_run<Element>(options, clock, progress, std::move(report), place_of_report,
                                     input)(std::move(problem));
    };
    if (volume)
    {
        std::optional<io::volume_file> file;
        report.seconds.read = clock.timed([&] { file = read_volume_at_rest(options.input, options.rest); });
        require_drawable(*file, {options.picture, options.cut});
        return with_case(*file, [&]<class Element>(const volume_case<Element>& input)
                         { return untangled(problem_of(input, options, report), &input); });
    }
    std::optional<decltype(io::read_any_prob({}))> file;
    report.seconds.read = clock.timed([&] { file = io::read_any_prob(options.input); });
    return std::visit(
        [&]<class Element>(io::prob_file<Element>& problem)
        {
            if (Element::dimension == 3 && !options.picture.empty())
                throw usage_error("--picture draws maps to the plane, and this problem has tetrahedra; leave it out");
            return untangled(make_untangle_problem(std::move(problem)));
        },
        *file);
}

} // namespace

command add_untangle(CLI::App& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<untangle_options>();
    auto& app = *program.add_subcommand("untangle",
                                        "Make a map, or a volume, injective while some vertices stay where they are");
    add_path(
        app, "PROBLEM", options->input, standard_input,
        "Problem (rest shape, initial map, cells and fixed vertices, as text), - is standard input; or a volume, or "
        "a mesh of the plane, with inverted elements: .mesh .msh .vtk .vtu .node .su2")
        ->required()
        ->type_name("FILE");
    add_path(
        app, "-o,--output", options->output, standard_output,
        "What to write; of a problem the map, a vertex a line, - is standard output; of a volume the same file with "
        "other coordinates. OUT.invalid if it is not injective")
        ->required()
        ->type_name("OUT");
    app.add_option("--rest", options->rest,
                   "The volume at rest, the same vertices and cells; without it elements are wanted to be regular")
        ->type_name("FILE");
    app.add_option("--pins", options->pins, "Vertices of the volume to hold: vertex,x,y,z, vertices from 0")
        ->type_name("FILE.csv");
    app.add_option("--fix", options->fixed, "Keep the vertices of a group where they are; more than once, if need be")
        ->type_name("GROUP");
    add_choice(app, "--boundary", options->boundary,
               std::vector<choice<untangle_boundary>>{{"auto", untangle_boundary::automatic},
                                                      {"fixed", untangle_boundary::fixed},
                                                      {"free", untangle_boundary::free}},
               "Whether the boundary of the volume stays where it is; auto: unless --pins or --fix hold something");
    add_time_limit(app, options->time_limit, "Give up after S seconds");
    add_device(app, options->device);
    add_path(app, "--stats", options->stats, standard_output, "Write numbers as JSON")->type_name("FILE.json");
    add_drawing(app, options->picture, options->cut, "Draw the map before and after, with its pins");
    add_progress(app, options->progress, options->quiet);
    app.footer("exit codes: 0 injective map; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
               "  6 not found, the best map is in OUT.invalid; 7 proved infeasible; 9 device failure; 130 interrupted, "
               "143 terminated");
    return [options, launch] { return run(*options, launch); };
}

} // namespace taut::tools
