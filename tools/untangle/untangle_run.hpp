// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/files.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/surface_file.hpp>
#include <taut/untangle.hpp>

#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"
#include "untangle/untangle_picture.hpp"
#include "untangle/untangle_report.hpp"
#include "volume/mend_insides.hpp"
#include "volume/refined_case.hpp"
#include "volume/volume_drawing.hpp"
#include "volume/volume_problem.hpp"
#include "volume/written_shape.hpp"

namespace taut::tools
{

/// One run of `taut untangle`, phase by phase.
template <class Element>
class untangle_run
{
public:
    static constexpr int D = Element::dimension;

    /// input: the volume file that the problem is of, if it is of one.
    untangle_run(const untangle_options& options, command_run& run, untangle_report report,
                 const volume_case<Element>* input)
        : options_(options), input_(input), command_(run), report_(std::move(report))
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
        if (options_.refine) require_refinable();
        if (options_.refine || !prove_infeasible()) solve();
        write();
        if (report_.code == exit_code::infeasible) throw infeasible_problem(report_.reason);
        if (valid_) return report_.code;
        const std::string why =
            report_.reason + (report_.written.empty() ? "" : "; the best map is in " + report_.written);
        if (interrupted()) throw interrupted_run(why);
        throw no_valid_map(why);
    }

private:
    /// Certifies the coordinates as a reader of the file will have them.
    certificate certified(const std::vector<vec<D>>& x, volume_state& state) const
    {
        if (!input_) return certify<D>(problem_->rest.cells(), std::span<const vec<D>>(x));
        state = input_->look(input_->as_written(x));
        return cells_of(state);
    }

    /// The certificate, counted in cells.
    static certificate cells_of(const volume_state& state)
    {
        auto found = state.simplices;
        found.flipped = state.inverted.size();
        return found;
    }

    /// Proofs need no device and no time, so they come first, and all of them are told.
    bool prove_infeasible()
    {
        command_.tell("check");
        impl::infeasibility found;
        report_.seconds.check = command_.clock.timed([&] { found = find_infeasibility(*problem_); });
        for (const auto& warning : found.warnings) report_.notes.push_back(warning.message);
        if (!found) return false;
        std::string all;
        for (const auto& proof : found.proofs) all += (all.empty() ? "" : "\n  ") + proof.message;
        refuse(all, std::move(found.proofs.front().ids));
        return true;
    }

    void refuse(const std::string& why, std::vector<idx> ids)
    {
        report_.code = exit_code::infeasible;
        report_.outcome = "infeasible";
        report_.after = report_.before;
        report_.ids = std::move(ids);
        report_.reason = why;
    }

    /// Before anything is solved. Throws unsuitable_input, io_error.
    void require_refinable()
    {
        if (!input_) problem_file_ = file_of(*problem_);
        tools::require_refinable(input_ ? input_->file() : *problem_file_);
    }

    /// The mesh from here on, some of whose elements are split.
    void go_on_with(refined_problem<Element> refined)
    {
        parts_ = std::move(refined.cells);
        if (!input_) problem_file_ = io::impl::subdivided(*problem_file_, refined.how);
        if (refined.how.empty()) return;
        report_.refined = {refined.rounds, static_cast<std::size_t>(refined.how.vertex_count()), parts_.size()};
        problem_ = std::move(refined.problem);
        if (!input_) return;
        refined_ = std::make_unique<refined_case<Element>>(input_->file(), refined.how);
        input_ = &refined_->parts();
        report_.notes.insert(report_.notes.end(), input_->file().notes.begin(), input_->file().notes.end());
    }

    void solve()
    {
        command_.tell("device");
        std::optional<queue> q;
        report_.seconds.device = command_.clock.timed([&] { q = open_queue(options_.device, false); });
        report_.device = q->device().name();
        report_.device_label = (std::ostringstream() << q->device()).str();

        command_.tell("untangle");
        keep(true); // the initial map, at least
        untangle_result<Element> result;
        report_.seconds.solve = command_.clock.timed(
            [&]
            {
                if (!options_.refine)
                    result = untangle(*q, *problem_, {}, limits());
                else
                {
                    auto found = untangle(*q, *problem_, {}, limits(), {});
                    result = std::move(found.result);
                    if (result.outcome != outcome::infeasible) go_on_with(std::move(found.refined));
                }
            });
        if (result.outcome == outcome::infeasible) return refuse(result.reason, std::move(result.ids));
        if (input_ && result) mend(*q, result);
        take(std::move(result));
    }

    /// Limits of the rest of the run: what reading took is gone.
    run_limits limits()
    {
        return {command_.clock.left(options_.time_limit), [this](const taut::progress& p)
                {
                    if (p.iterate) command_.tell({.phase = "untangle", .step = p.iteration, .inverted = p.value});
                    return !interrupted();
                }};
    }

    /// Cells that came out negative inside are untangled once more.
    void mend(queue& q, untangle_result<Element>& result)
    {
        const auto again = [&](const volume_case<Element>& edged, const std::vector<vec<D>>& from)
        {
            untangle_report told; // it was before
            auto problem = problem_of(edged, options_, told);
            problem.initial = from;
            problem.held = problem_->held;
            auto found = untangle(q, problem, {}, limits());
            result.stages.insert(result.stages.end(), found.stages.begin(), found.stages.end());
            return found ? std::move(found.map) : std::vector<vec<D>>();
        };
        auto note = mend_insides(*input_, result.map, again);
        if (!note.empty()) report_.notes.push_back(std::move(note));
    }

    /// The certificate of exactly what is written, and the pins bit for bit, not taken from the solver's word.
    void take(untangle_result<Element> result)
    {
        std::string defects; // of rounding
        if (!input_)
            report_.after = certified(result.map, report_.state_after);
        else
        {
            const auto movable = [&](std::size_t v, int k) { return !problem_->held.test(v, k); };
            written_shape<Element> written(*input_, std::move(result.map), movable);
            if (result) defects = written.defects(*input_);
            if (!written.note.empty()) report_.notes.push_back(std::move(written.note));
            result.map = std::move(written.x);
            points_ = std::move(written.points);
            report_.state_after = std::move(written.state);
            report_.after = cells_of(report_.state_after);
        }
        bool held = true;
        for (std::size_t v = 0; v < problem_->held.size(); ++v)
            for (int k = 0; k < D; ++k)
                held = held && (!problem_->held.test(v, k) || result.map[v][k] == problem_->initial[v][k]);
        const bool valid = held && report_.after;
        report_.outcome = valid ? "injective" : interrupted() ? "interrupted" : "gave_up";
        report_.code = interrupted() ? interruption() : valid ? exit_code::valid : exit_code::no_valid_map;
        report_.reason = valid ? "" : !held ? "a pin has moved" : defects.empty() ? result.reason : defects;
        report_.ids = std::move(result.ids);
        report_.least_det = result.flips.min_det;
        report_.least_relative_det = result.least_relative_det;
        report_.stage = std::move(result.stage);
        report_.stages = std::move(result.stages);
        valid_ = valid;
        map_ = std::move(result.map);
    }

    void write()
    {
        std::vector<io::file_to_write> files;
        // A map with defects never gets the name that was asked for.
        if (!map_.empty()) report_.written = valid_ ? options_.output : name_of_invalid(options_.output);
        if (input_ && valid_)
            files = io::impl::volume_outputs(report_.written, input_->file(), points_);
        else if (!report_.written.empty())
            files.push_back({report_.written, [&](io::atomic_file& file)
                             {
                                 if (input_)
                                     file.write(io::impl::with_points(input_->file(), points_));
                                 else if (problem_file_)
                                     file.write(io::impl::with_points(*problem_file_, in_space()));
                                 else
                                     io::write_map<D>(file, map_);
                             }});
        if (valid_ && !options_.refined_map.empty())
            files.push_back({options_.refined_map, [&](io::atomic_file& file) { file.write(table_of_parts(parts_)); }});
        if (drawn(options_.picture, report_.notes))
            files.push_back({options_.picture, [&](io::atomic_file& file) { file.write(picture()); }});
        command_.write(std::move(files), report_, options_,
                       [&](double total, double write)
                       { report_.seconds.total = total, report_.seconds.write = write; });
        if (valid_) remove_invalid(options_.output);
    }

    /// The map as points of a file.
    std::vector<vec3> in_space() const
    {
        std::vector<vec3> points(map_.size(), vec3(0.0));
        for (std::size_t v = 0; v < map_.size(); ++v)
            for (int k = 0; k < D; ++k) points[v][k] = map_[v][k];
        return points;
    }

    std::string picture() const
    {
        const std::string name = std::filesystem::path(options_.input).filename().string();
        if (input_) return picture_of(*input_, name);
        if constexpr (D == 2)
            return picture_of_problem(name);
        else
        {
            const auto file = file_of(*problem_);
            return picture_of(volume_case<Element>(file), name);
        }
    }

    std::string picture_of(const volume_case<Element>& shown, const std::string& name) const
    {
        const bool by_shape = shown.file().rest.empty();
        std::vector<drawn_state> states{state_to_draw(shown, name + ": before", problem_->initial, by_shape)};
        if (!map_.empty()) states.push_back(state_to_draw(shown, "after: " + report_.outcome, map_, by_shape));
        return draw_states(shown.file(), states, {options_.picture, options_.clip, by_shape});
    }

    std::string picture_of_problem(const std::string& name) const requires(D == 2)
    {
        std::vector<layout_input> maps{
            {problem_->initial,
             {.title = name + ": before", .note = count(report_.pinned, "vertex pinned", "vertices pinned")}}};
        if (!map_.empty())
            maps.push_back(
                {map_, {.title = "after", .note = report_.outcome + (valid_ ? " by " + report_.stage : "")}});
        else
            maps.back().style.note += ", infeasible";
        return draw(options_.picture, *problem_, maps);
    }

    untangle_options options_;
    const volume_case<Element>* input_; ///< null: there is none
    std::unique_ptr<refined_case<Element>> refined_;
    std::optional<io::volume_file> problem_file_; ///< of what is no volume file, where it is refined
    std::vector<idx> parts_;                      ///< of each element, that of the input; where it is refined
    command_run& command_;
    untangle_report report_;
    std::optional<untangle_problem<Element>> problem_;
    std::vector<vec<D>> map_;
    std::vector<vec3> points_; ///< of the file, where there is one
    bool valid_ = false;
};

} // namespace taut::tools
