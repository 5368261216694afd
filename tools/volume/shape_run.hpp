// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/files.hpp>
#include <taut/impl/core/map/smooth.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/smooth.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/printable.hpp"
#include "shared/writing.hpp"
#include "volume/deform_report.hpp"
#include "volume/group_targets.hpp"
#include "volume/mend_insides.hpp"
#include "volume/refined_case.hpp"
#include "volume/volume_drawing.hpp"
#include "volume/written_shape.hpp"

namespace taut::tools
{

/// One run of `taut deform` or `taut smooth`.
template <class Element>
class shape_run
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    /// All is referred to.
    shape_run(const shape_options& options, command_run& run, const volume_case<Element>& input)
        : options_(options), command_(run), input_(&input)
    {
        report_.seconds.read = command_.clock.now();
        report_.format = input.file().format;
        report_.cells = count_cells(input.file(), D);
        report_.element = input.element();
        report_.vertices = input.file().points.size();
        report_.elements = input.cells();
        report_.dimension = D;
        report_.mixed = input.parts().overlapping;
    }

    exit_code operator()()
    {
        prepare();
        if (options_.refine) require_refinable(input_->file());
        command_.tell("device");
        std::optional<queue> q;
        report_.seconds.device = command_.clock.timed([&] { q = open_queue(options_.device, false); });
        report_.device = q->device().name();
        command_.tell(phase());
        report_.before = input_->look(input_->points());
        report_.seconds.solve = command_.clock.timed([&] { solve(*q); });
        if (!valid_) refuse();
        write();
        return code_;
    }

private:
    const char* phase() const { return options_.smoothing ? "smooth" : "deform"; }

    void add_note(std::string note)
    {
        if (!note.empty()) notes_.push_back(std::move(note));
    }

    void prepare()
    {
        require_name(options_.output, input_->file());
        for (const auto& note : input_->file().notes) add_note(note);
        if (!input_->file().turned.empty()) add_note(turned_note(input_->file()));
        group_targets targets(input_->file());
        for (const auto& name : options_.fixed) targets.fix(name);
        for (const auto& move : options_.moves) targets.move(move);
        add_note(targets.note());
        if (options_.smoothing)
        {
            for (const auto& [v, x] : targets.all()) fixed_.push_back(v);
            keep_interfaces();
            return;
        }
        const auto& mesh = input_->simplices();
        pins_ = constraints<Element>(mesh);
        held_by_file held(input_->file());
        targets.pin(pins_, held);
        if (!options_.pins.empty())
        {
            auto read = input_->read_pins(options_.pins);
            if (read.empty()) add_note(options_.pins + no_pins);
            pins_.add(held(std::move(read)));
        }
        report_.pin_rounding = held.largest();
        add_note(held.note());
        report_.pins = pins_.pins().size();
        report_.springs = pins_.springs().size();
    }

    /// Keeps the interfaces of a file with regions or labelled faces.
    void keep_interfaces()
    {
        if (options_.free_interfaces) return;
        const auto& file = input_->file();
        kept_facets_ = file.kept_facets(options_.boundary == smooth_boundary::sliding);
        std::vector<char> outside(file.points.size(), 0), inside = outside;
        for (const auto& facet : impl::boundary_facets(input_->simplices(), input_->owners()))
            for (const idx v : facet) outside[static_cast<std::size_t>(v)] = 1;
        for (const auto& facet : kept_facets_)
            for (const idx v : facet.corners()) inside[static_cast<std::size_t>(v)] = 1;
        std::size_t kept = 0;
        for (std::size_t v = 0; v < inside.size(); ++v) kept += inside[v] && !outside[v];
        if (kept > 0) add_note(kept_interfaces_note(kept));
    }

    run_limits limits()
    {
        return {command_.clock.left(options_.time_limit), [this](const taut::progress& p)
                {
                    keep(kept_ || p.usable);
                    if (p.iterate)
                        command_.tell(
                            {.phase = phase(), .step = p.iteration, .energy = p.value, .gradient = p.gradient});
                    return !interrupted();
                }};
    }

    /// With these simplices of the cells, from a shape; the shape that is found, empty if there is none.
    session_result<Element> solve(queue& q, const volume_case<Element>& parts, const map& from)
    {
        if (options_.smoothing)
        {
            const mesh<Element> m(input_->in_file(from), parts.simplices().cells());
            smooth_params<Element> params{.boundary = options_.boundary,
                                          .targets = parts.parts().regular,
                                          .owners = parts.owners(),
                                          .worst_exponent = options_.worst_exponent,
                                          .fixed = fixed_,
                                          .kept = kept_facets_};
            if (options_.tolerance) params.solve.gradient_tolerance = *options_.tolerance;
            auto r = smooth(q, m, params, limits());
            return {std::move(r.x), std::move(r.report)};
        }
        deform_params<Element> params{
            .energy = energy_of(options_.energy), .constraints = pins_, .owners = parts.owners(), .initial = from};
        if (parts.parts().overlapping) params.data.weights = parts.parts().weights;
        if (options_.tolerance) params.solve.gradient_tolerance = *options_.tolerance;
        if (options_.refine) return deform_split(q, parts, params);
        return deform(q, parts.simplices(), params, limits());
    }

    session_result<Element> deform_split(queue& q, const volume_case<Element>& parts,
                                         const deform_params<Element>& params)
    {
        auto found = deform(q, parts.simplices(), params, limits(), {});
        parts_ = std::move(found.cells);
        if (!found.how.empty())
        {
            report_.refined = {found.rounds, static_cast<std::size_t>(found.how.vertex_count()), parts_.size()};
            refined_ = std::make_unique<refined_case<Element>>(parts.file(), found.how);
            input_ = &refined_->parts();
            auto& notes = found.result.report.notes;
            notes.insert(notes.end(), input_->file().notes.begin(), input_->file().notes.end());
        }
        return std::move(found.result);
    }

    void solve(queue& q)
    {
        auto [x, run] = solve(q, *input_, input_->points());
        report_.run = std::move(run);
        kept_ = !x.empty();
        keep(kept_);
        if (report_.run.outcome == outcome::valid && !report_.run.stopped)
        {
            pins_.rotations({}); // they are at their ends
            const auto again = [&](const volume_case<Element>& edged, const map& from)
            {
                auto [other, how] = solve(q, edged, from);
                auto& all = report_.run;
                all.steps += how.steps;
                all.stages.insert(all.stages.end(), how.stages.begin(), how.stages.end());
                if (how.outcome != outcome::valid || !how.pins_held) return map();
                all.energy = how.energy;
                all.gradient = how.gradient;
                all.converged = how.converged;
                all.stopped = how.stopped;
                return other;
            };
            add_note(mend_insides(*input_, x, again));
        }
        if (!options_.smoothing && report_.pins + report_.springs == 0) add_note(nothing_held);
        if (options_.smoothing && options_.boundary == smooth_boundary::free && fixed_.empty())
            add_note("nothing is fixed, and the boundary is free: the mesh may move as a whole; --fix "
                     "prevents that");
        take(std::move(x));
        report_.run.notes.insert(report_.run.notes.end(), notes_.begin(), notes_.end());
    }

    /// Returns whether writing may round a coordinate: it is none that the user, or a boundary that slides, holds.
    auto movable(const map& x) const
    {
        std::vector<char> still(x.size(), 0);
        for (const idx v : fixed_) still[static_cast<std::size_t>(v)] = 1;
        const auto marks = pins_.held();
        return [this, still, marks, &x](std::size_t v, int k)
        {
            if (!options_.smoothing) return !(v < marks.size() && marks.test(v, k));
            return !still[v] && (v >= input_->file().points.size() || x[v][k] != input_->file().points[v][k]);
        };
    }

    /// The certificate of exactly what is written, and the pins bit for bit, not taken from the solver's word.
    void take(const map& x)
    {
        session_report& run = report_.run;
        const bool late = run.outcome == outcome::stopped || (run.outcome == outcome::valid && run.stopped);
        code_ = interrupted()                        ? interruption()
                : late                               ? exit_code::time_limit
                : run.outcome == outcome::valid      ? exit_code::valid
                : run.outcome == outcome::infeasible ? exit_code::infeasible
                                                     : exit_code::no_valid_map;
        if (x.empty() || code_ == exit_code::infeasible || code_ == exit_code::no_valid_map) return;
        written_shape<Element> written(*input_, x, movable(x));
        add_note(written.note);
        const bool held = measure_pins(written.x) || !run.pins_held;
        valid_ = held && written.state.simplices;
        if (!valid_)
        {
            code_ = exit_code::no_valid_map;
            run.reason = held ? written.defects(*input_) : "a pin has moved";
        }
        points_ = std::move(written.points);
        report_.after = std::move(written.state);
    }

    /// Measures the distances of pins from their targets in the output; returns whether all are met.
    bool measure_pins(const map& x)
    {
        session_report& run = report_.run;
        bool held = true;
        double most = 0;
        for (const auto& [v, pin] : pins_.pins())
        {
            vec<D> gap(0.0);
            for (int k = 0; k < D; ++k)
                if ((pin.held >> k & 1u) != 0) gap[k] = x[static_cast<std::size_t>(v)][k] - pin.value[k];
            if (gap == vec<D>(0.0)) continue;
            held = false;
            if (const double distance = glm::length(gap); run.farthest < 0 || distance > most)
                run.farthest = v, most = distance;
        }
        if (!held) run.distance = most;
        return held;
    }

    [[noreturn]] void refuse() const
    {
        const std::string& why = report_.run.reason;
        command_.finish();
        if (!options_.quiet)
            for (const auto& note : notes_) std::cerr << "taut: note: " << printable(note) << '\n';
        if (code_ == exit_code::infeasible) throw infeasible_problem(why);
        if (interrupted()) throw interrupted_run("there was no mesh to write yet");
        throw no_valid_map(why.empty() ? "nothing was written" : why);
    }

    void write()
    {
        auto files = io::impl::volume_outputs(options_.output, input_->file(), points_);
        if (!options_.refined_map.empty())
            files.push_back({options_.refined_map, [&](io::atomic_file& file) { file.write(table_of_parts(parts_)); }});
        drawing_options drawing{options_.picture, options_.clip, options_.smoothing};
        if (drawn(drawing.path, report_.run.notes))
            files.push_back({drawing.path, [&](io::atomic_file& file) { file.write(picture(drawing)); }});
        command_.write(std::move(files), report_, options_,
                       [&](double total, double) { report_.seconds.total = total; });
    }

    std::string picture(const drawing_options& drawing) const
    {
        const std::string name = std::filesystem::path(options_.input).filename().string();
        const map x(points_.begin(), points_.end());
        return draw_states(input_->file(),
                           {state_to_draw(*input_, name + ": before", input_->points(), options_.smoothing),
                            state_to_draw(*input_, "after", x, options_.smoothing)},
                           drawing);
    }

    const shape_options& options_;
    command_run& command_;
    const volume_case<Element>* input_;
    std::unique_ptr<refined_case<Element>> refined_;
    std::vector<idx> parts_; ///< of each element, that of the input; where it is refined
    constraints<Element> pins_;
    std::vector<idx> fixed_;
    std::vector<impl::kept_facet> kept_facets_;
    std::vector<vec3> points_;
    std::vector<std::string> notes_; ///< of the command, behind those of the library
    deform_report report_;
    exit_code code_ = exit_code::valid;
    bool valid_ = false, kept_ = false; ///< kept_: there is a result already
};

} // namespace taut::tools
