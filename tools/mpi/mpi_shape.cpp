// SPDX-License-Identifier: MIT
#include "mpi/mpi_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/dist/ranges/deal.hpp>
#include <taut/impl/dist/shape/smooth.hpp>
#include <taut/impl/files/file/file_target.hpp>

#include "mpi/case_folder.hpp"
#include "mpi/checkpoint.hpp"
#include "mpi/mpi_report.hpp"
#include "mpi/processes.hpp"
#include "mpi/shape_source.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/peak_memory.hpp"
#include "shared/progress.hpp"
#include "shared/report_files.hpp"
#include "shared/run_clock.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"

namespace taut::tools::mpi
{

namespace
{

double processor_seconds()
{
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What runs share whatever the dimension.
struct run_base
{
    const dist::impl::communicator& all;
    const mpi_options& options;
    const char* place; ///< of the report
    run_clock clock;
    progress shown;
    mpi_report report;
    process_numbers numbers;

    run_base(const dist::impl::communicator& processes, const mpi_options& o, const char* place_of_report,
             run_clock launched)
        : all(processes),
          options(o),
          place(place_of_report),
          clock(launched),
          shown(first() ? progress_of(o.shape.progress, o.shape.quiet) : progress_mode::none, std::cerr)
    {
    }

    bool first() const { return all.rank() == 0; }
    void tell(std::string_view phase) { shown.update({.phase = phase, .seconds = clock.now()}); }
};

/// A run, step by step; each is collective.
template <class Element>
class collective_run
{
public:
    static constexpr int D = Element::dimension;
    using points = typename shape_source<Element>::points;

    collective_run(run_base& base, std::unique_ptr<shape_source<Element>> source)
        : base_(base),
          all_(base.all),
          options_(base.options),
          shape_(options_.shape),
          report_(base.report),
          source_(std::move(source))
    {
    }

    exit_code operator()()
    {
        require_not_interrupted();
        base_.tell("distribute");
        solve();
        const auto outcome = report_.run.outcome;
        const bool late = outcome == outcome::stopped || (outcome == outcome::valid && report_.run.stopped);
        code_ = asked_to_stop()                  ? stopped_by_
                : late                           ? exit_code::time_limit
                : outcome == outcome::valid      ? exit_code::valid
                : outcome == outcome::infeasible ? exit_code::infeasible
                                                 : exit_code::no_valid_map;
        write();
        if (code_ == exit_code::valid) checkpoint<Element>(all_, options_, *source_).remove();
        return code_;
    }

private:
    /// Whether any process was, and by which signal.
    bool asked_to_stop()
    {
        const std::int64_t worst = all_.most(std::int64_t{interrupted() ? to_int(interruption()) : 0});
        stopped_by_ = worst == to_int(exit_code::terminated) ? exit_code::terminated : exit_code::interrupted;
        return worst > 0;
    }
    void require_not_interrupted()
    {
        const bool stop = asked_to_stop();
        all_.together(
            [&]
            {
                if (stop) throw interrupted_run("there was no mesh to write yet");
            });
    }

    const char* phase() const { return shape_.smoothing ? "smooth" : "deform"; }

    run_limits limits()
    {
        run_limits l;
        l.time_limit = base_.clock.left(shape_.time_limit);
        l.observer = [this](const taut::progress& p)
        {
            if (p.iterate)
                base_.shown.update({.phase = phase(),
                                    .step = p.iteration,
                                    .energy = p.value,
                                    .gradient = p.gradient,
                                    .seconds = base_.clock.now()});
            return !interrupted();
        };
        return l;
    }

    /// A session of the mesh, to begin with a shape; empty: that of the mesh.
    dist::session<Element> opened(const dist::mesh_piece<Element>& piece, const queue& q, points from)
    {
        const auto set_tolerance = [this](auto& how)
        {
            if (shape_.tolerance) how.solve.gradient_tolerance = *shape_.tolerance;
        };
        if (shape_.smoothing)
        {
            dist::smooth_params how{.boundary = shape_.boundary,
                                    .worst_exponent = shape_.worst_exponent,
                                    .fixed = source_->fixed,
                                    .regions = source_->regions_of(piece),
                                    .faces = source_->kept.faces,
                                    .solver = options_.solver,
                                    .queue = q};
            for (const auto& x : from)
                if constexpr (D == 3)
                    how.initial.push_back(x);
                else
                    how.initial.emplace_back(x, 0.0);
            set_tolerance(how);
            return dist::impl::smoothing_session<Element>(all_.raw(), piece, how);
        }
        dist::deform_params<Element> how{.energy = energy_of(shape_.energy),
                                         .constraints = source_->pins,
                                         .initial = std::move(from),
                                         .solver = options_.solver,
                                         .queue = q};
        set_tolerance(how);
        return dist::session<Element>(all_.raw(), piece, how);
    }

    void solve()
    {
        const double begin = base_.clock.now();
        const queue q = own_queue(all_, shape_.device);
        if (base_.first()) report_.device = q.device().name();
        const checkpoint<Element> kept(all_, options_, *source_);
        auto begin_with = kept.read();
        if (!all_.any(!begin_with.empty())) begin_with = source_->initial;
        dist::result<Element> found;
        {
            auto session = opened(source_->piece, q, std::move(begin_with));
            base_.numbers.distributed = sent_so_far();
            report_.seconds.distribute = base_.clock.now() - begin;
            require_not_interrupted();
            base_.tell(phase());
            found = kept.solve(session, [this] { return limits(); });
        }
        if (source_->mixed && D == 3 && found.report.outcome == outcome::valid && !found.report.stopped)
            mend_insides(found, q);
        report_.seconds.solve = base_.clock.now() - begin - report_.seconds.distribute;
        report_.run = std::move(found.report);
        x_ = std::move(found.x);
        count_process();
    }

    /// As the serial program: solves again with the tetrahedra at the edges of cells that are not valid though their
    /// corners are positive, as long as that leaves fewer of them.
    void mend_insides(dist::result<Element>& found, const queue& q)
    {
        const auto total = [this](const std::vector<idx>& cells)
        { return all_.sum(static_cast<std::int64_t>(cells.size())); };
        auto next = source_->doubtful(found.x);
        std::int64_t left = total(next);
        const std::int64_t first = left;
        std::vector<idx> edged;
        for (int round = 0; left > 0 && round < 5; ++round)
        {
            std::vector<idx> both;
            std::set_union(edged.begin(), edged.end(), next.begin(), next.end(), std::back_inserter(both));
            if (!all_.any(both.size() > edged.size())) break; // they have them already
            edged = std::move(both);
            auto session = opened(source_->edged(edged), q, found.x);
            auto other = session.solve(limits());
            other.report.steps += found.report.steps;
            other.report.products += found.report.products;
            if (other.report.outcome != outcome::valid || !other.report.pins_held) break;
            next = source_->doubtful(other.x);
            if (total(next) >= left) continue;
            left = total(next);
            other.report.notes.insert(other.report.notes.begin(), found.report.notes.begin(), found.report.notes.end());
            found = std::move(other);
        }
        const std::int64_t solved = total(edged);
        if (first > 0)
            found.report.notes.push_back(count(static_cast<std::uint64_t>(first), "cell was", "cells were") +
                                         " negative inside; solved again with the tetrahedra at the edges of " +
                                         count(static_cast<std::uint64_t>(solved), "cell", "cells") + ", " +
                                         (left == 0 ? "none" : count(static_cast<std::uint64_t>(left))) + " left");
    }

    void count_process()
    {
        auto& n = base_.numbers;
        const auto now = sent_so_far();
        const auto& before = n.distributed;
        n.solved = {now.messages - before.messages, now.bytes - before.bytes, now.reductions - before.reductions,
                    now.exchanges - before.exchanges};
        n.seconds = report_.run.seconds;
        n.processor = processor_seconds();
        n.peak_memory = peak_memory();
        n.device_bytes = report_.run.device_bytes;
        n.own_vertices = report_.run.own_vertices;
        n.halo_vertices = report_.run.halo_vertices;
        n.cells = report_.run.local_cells;
        report_.processes = dist::impl::collected(all_, std::vector{n});
    }

    /// Of process 0. Throws where there is nothing to be written; adds notes.
    void require_shape()
    {
        auto& found = report_.run;
        if (!found.flips || code_ == exit_code::no_valid_map || code_ == exit_code::infeasible)
        {
            base_.shown.finish();
            if (code_ == exit_code::infeasible) throw infeasible_problem(found.reason);
            throw no_valid_map(found.reason.empty() ? "nothing was written" : found.reason);
        }
        found.notes.insert(found.notes.end(), source_->notes.begin(), source_->notes.end());
        if (!options_.checkpoint.empty() && std::isfinite(shape_.time_limit) &&
            shape_.time_limit <= options_.checkpoint_interval)
            found.notes.push_back("--checkpoint: none was written, as --time-limit is no longer than its interval");
        if (!shape_.smoothing && report_.pins + report_.springs == 0) found.notes.push_back(nothing_held);
        if (found.on_interfaces > 0)
            found.notes.push_back(kept_interfaces_note(static_cast<std::uint64_t>(found.on_interfaces)));
    }

    /// All files appear, or none.
    void write()
    {
        report_.seconds.read = base_.numbers.read;
        if (base_.first()) base_.tell("write");
        all_.together(
            [&]
            {
                if (base_.first()) require_shape();
            });
        source_->finish(x_, report_,
                        [this](std::vector<io::file_to_write> files)
                        {
                            write_with_report(std::move(files), report_, named{options_, shape_.stats}, base_.place,
                                              base_.shown, [&] { report_.seconds.total = base_.clock.now(); });
                        });
    }

    /// As write_with_report() wants them.
    struct named
    {
        const mpi_options& options;
        const std::string& stats;
        operator const mpi_options&() const { return options; }
    };

    run_base& base_;
    const dist::impl::communicator& all_;
    const mpi_options& options_;
    const shape_options& shape_;
    mpi_report& report_;
    std::unique_ptr<shape_source<Element>> source_;
    points x_; ///< of the piece
    exit_code code_ = exit_code::valid, stopped_by_ = exit_code::interrupted;
};

/// The output is of the kind of the input: a new folder for a case of OpenFOAM, else a file. Throws usage_error.
void require_kind(const shape_options& o)
{
    namespace fs = std::filesystem;
    std::error_code unknown;
    const fs::path path = o.output;
    const bool there = fs::exists(path, unknown), folder = fs::is_directory(path, unknown);
    if (fs::is_directory(o.input, unknown))
    {
        if (there) throw usage_error("-o " + o.output + ": is there already; name a folder that is not, or remove it");
        for (const auto* name : {&o.output, &o.stats})
            if (!name->empty() && io::impl::open_file_number(*name) < 0 && lies_in(*name, o.input))
                throw usage_error(*name + ": lies in the input " + o.input +
                                  ", as a part of which it would be taken; name a place outside of it");
    }
    else if (folder || !path.has_filename())
        throw usage_error("-o " + o.output + ": is a folder, and the mesh is a file; name a file");
}

} // namespace

exit_code run_shape(const dist::impl::communicator& all, const mpi_options& options, const char* place_of_report,
                    std::chrono::steady_clock::time_point launch)
{
    run_base base(all, options, place_of_report, run_clock(launch));
    all.together(
        [&]
        {
            if (all.rank() == 0) require_kind(options.shape);
        });
    base.tell("read");
    const double begin = base.clock.now();
    std::unique_ptr<shape_source<tetrahedron>> volume = ranged_source(all, options, base.report);
    std::unique_ptr<shape_source<triangle>> plane;
    if (!volume)
    {
        io::volume_file file;
        all.together(
            [&]
            {
                if (all.rank() == 0) file = read_whole(options);
            });
        if (all.shared(file.dimension) == 2)
            plane = whole_source<triangle>(all, options, base.report, std::move(file));
        else
            volume = whole_source<tetrahedron>(all, options, base.report, std::move(file));
    }
    base.numbers.read = base.clock.now() - begin;
    if (plane) return collective_run<triangle>(base, std::move(plane))();
    return collective_run<tetrahedron>(base, std::move(volume))();
}

} // namespace taut::tools::mpi
