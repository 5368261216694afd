// SPDX-License-Identifier: MIT
#include "mpi/mpi_shape.hpp"

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/dist/deal.hpp>
#include <taut/impl/dist/file/open_volume.hpp>
#include <taut/impl/dist/file/piece_shapes.hpp>
#include <taut/impl/io/make_untangle_problem.hpp>
#include <taut/impl/io/pins.hpp>
#include <taut/impl/io/write_files.hpp>
#include <taut/impl/io/write_volume.hpp>

#include "mpi/checkpoint.hpp"
#include "mpi/mpi_report.hpp"
#include "mpi/processes.hpp"
#include "mpi/ranged_targets.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/progress.hpp"
#include "shared/report_files.hpp"
#include "shared/run_clock.hpp"
#include "shared/shared_options.hpp"
#include "volume/group_targets.hpp"
#include "volume/written_shape.hpp"

namespace taut::tools::mpi
{

namespace
{

using element = tetrahedron;
using points = std::vector<vec3>;

/// What the first process knows, who reads and writes; the others have none.
struct reader
{
    io::volume_file file;
    std::optional<volume_case<element>> input;
    taut::constraints<element> pins;
    std::vector<idx> fixed; ///< of a smoothing
    std::vector<std::string> notes;
};

std::unique_ptr<reader> read(const mpi_options& o, mpi_report& report)
{
    const auto& shape = o.shape;
    check(shape);
    if (names_surface(shape.input))
        throw unsuitable_input(shape.input + ": a surface in space is small enough for one process; use `taut deform`");
    auto r = std::make_unique<reader>();
    r->file = read_volume_at_rest(shape.input, shape.rest, shape.zone);
    if (shape.smoothing) r->file.rest.clear();
    require_mesh(r->file);
    if (r->file.dimension != 3)
        throw unsuitable_input(shape.input + ": a mesh of the plane; taut-mpi takes tetrahedra, `taut deform` both");
    r->input.emplace(r->file);
    if (r->input->parts().overlapping)
        throw unsuitable_input(shape.input + ": " + count_cells(r->file, 3) +
                               "; taut-mpi takes tetrahedra alone, `taut deform` and `taut smooth` take the others");
    require_name(shape.output, r->file);
    r->notes = r->file.notes;
    if (!r->file.turned.empty()) r->notes.push_back(turned_note(r->file));
    group_targets targets(r->file);
    for (const auto& name : shape.fixed) targets.fix(name);
    for (const auto& move : shape.moves) targets.move(move);
    if (auto note = targets.note(); !note.empty()) r->notes.push_back(std::move(note));
    if (shape.smoothing)
        for (const auto& [v, x] : targets.all()) r->fixed.push_back(v);
    else
    {
        const auto& mesh = r->input->simplices();
        r->pins = taut::constraints<element>(mesh);
        held_by_file held(r->file);
        for (const auto& [v, x] : targets.all()) r->pins.pin(v, held(v, x));
        if (!shape.pins.empty()) add_pins(r->pins, held(io::read_pins<3>(shape.pins, mesh.vertex_count())));
        if (auto note = held.note(); !note.empty()) r->notes.push_back(std::move(note));
    }
    report.format = r->file.format;
    report.cells = count_cells(r->file, 3);
    report.vertices = r->file.points.size();
    report.elements = r->input->cells();
    report.pins = r->pins.pins().size();
    report.springs = r->pins.springs().size();
    report.before = r->input->look(r->input->points());
    return r;
}

dist::constraints<element> constraints_of(const reader* r)
{
    dist::constraints<element> c;
    if (!r) return c;
    for (const auto& [v, pin] : r->pins.pins())
        for (int k = 0; k < 3; ++k)
            if ((pin.held >> k & 1U) != 0) c.pin(v, k, pin.value[k]);
    for (const auto& s : r->pins.springs())
        if (s.weight > 0) c.spring(s.vertex, s.target, s.weight);
    return c;
}

/// What names of outputs are held against.
io::volume_file head_of(const dist::impl::ranged_volume& volume, const std::string& path)
{
    io::volume_file file;
    file.path = path;
    file.format = volume.format;
    if (volume.format == io::impl::name_of(io::volume_format::tetgen))
    {
        file.path = std::filesystem::path(path).replace_extension(".node").string();
        file.companions = {{".ele", {}}, {".face", {}}};
    }
    return file;
}

/// The input read by ranges; null where process 0 has to read it. Collective.
std::unique_ptr<dist::impl::ranged_volume> read_by_ranges(const dist::impl::communicator& all, const mpi_options& o,
                                                          mpi_report& report)
{
    const auto& shape = o.shape;
    try
    {
        if (!shape.rest.empty() || shape.zone != 0) throw dist::impl::unsuited("--rest or --zone is given");
        auto volume = dist::impl::open_volume(all, shape.input);
        report.before.shapes = dist::impl::piece_shapes(all, volume->at_corners(volume->piece.points));
        if (!(report.before.shapes.worst.mean_ratio > 0)) throw dist::impl::unsuited("cells are inverted or flat");
        all.together(
            [&]
            {
                if (all.rank() != 0) return;
                check(shape);
                require_name(shape.output, head_of(*volume, shape.input));
                if (io::impl::is_stream(shape.output)) throw usage_error("-o: name a file");
            });
        report.format = volume->format;
        report.cells = count(static_cast<std::uint64_t>(volume->cells), "tetrahedron", "tetrahedra");
        report.vertices = static_cast<std::size_t>(volume->vertices);
        report.elements = static_cast<std::size_t>(volume->cells);
        return volume;
    }
    catch (const dist::impl::unsuited& e)
    {
        report.before = volume_state();
        report.read_whole = e.what();
        return nullptr;
    }
}

double processor_seconds()
{
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A run, step by step; each is collective.
class collective_run
{
public:
    collective_run(const dist::impl::communicator& all, const mpi_options& options, const char* place, run_clock clock)
        : all_(all),
          options_(options),
          shape_(options.shape),
          place_(place),
          clock_(clock),
          shown_(all.rank() == 0 ? progress_of(shape_.progress, shape_.quiet) : progress_mode::none, std::cerr)
    {
    }

    exit_code operator()()
    {
        tell("read");
        numbers_.read = clock_.timed([this] { read_input(); });
        require_not_interrupted();
        tell("distribute");
        solve();
        const auto outcome = report_.run.outcome;
        const bool late = outcome == outcome::stopped || (outcome == outcome::valid && report_.run.stopped);
        code_ = asked_to_stop()                  ? stopped_by_
                : late                           ? exit_code::time_limit
                : outcome == outcome::valid      ? exit_code::valid
                : outcome == outcome::infeasible ? exit_code::infeasible
                                                 : exit_code::no_valid_map;
        write();
        if (code_ == exit_code::valid)
            checkpoint(all_, options_, ranged_.get(), reader_ ? &reader_->file : nullptr).remove();
        return code_;
    }

private:
    bool first() const { return all_.rank() == 0; }

    void read_input()
    {
        ranged_ = read_by_ranges(all_, options_, report_);
        if (!ranged_)
            return all_.together(
                [&]
                {
                    if (first()) reader_ = read(options_, report_);
                });
        held_ = targets_of(*ranged_, shape_);
        report_.pins = static_cast<std::size_t>(held_.pinned);
        report_.springs = static_cast<std::size_t>(held_.springs);
    }

    void tell(std::string_view phase) { shown_.update({.phase = phase, .seconds = clock_.now()}); }

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

    run_limits limits()
    {
        run_limits l;
        l.time_limit = clock_.left(shape_.time_limit);
        l.observer = [this](const taut::progress& p)
        {
            if (p.iterate)
                shown_.update({.phase = shape_.smoothing ? "smooth" : "deform",
                               .step = p.iteration,
                               .energy = p.value,
                               .gradient = p.gradient,
                               .seconds = clock_.now()});
            return !interrupted();
        };
        return l;
    }

    void solve()
    {
        const double begin = clock_.now();
        points shape;
        const auto dealt = ranged_ ? dist::mesh_piece<element>() : dealt_piece(shape);
        const auto& piece = ranged_ ? ranged_->piece : dealt;
        const queue q = own_queue(all_, shape_.device);
        if (first()) report_.device = q.device().name();
        dist::result<element> found;
        if (shape_.smoothing)
        {
            dist::smooth_params how{.boundary = shape_.boundary,
                                    .worst_exponent = shape_.worst_exponent,
                                    .solver = options_.solver,
                                    .queue = q,
                                    .limits = limits()};
            if (ranged_) how.fixed = held_.fixed;
            if (reader_) how.fixed.assign(reader_->fixed.begin(), reader_->fixed.end());
            if (shape_.tolerance) how.solve.stopping.gradient_tolerance = *shape_.tolerance;
            numbers_.distributed = sent_so_far();
            found = dist::smooth<element>(all_.raw(), piece, how);
        }
        else
        {
            const checkpoint kept(all_, options_, ranged_.get(), reader_ ? &reader_->file : nullptr);
            auto begin_with = kept.read();
            if (!all_.any(!begin_with.empty())) begin_with = std::move(shape);
            dist::deform_params<element> how{.energy = energy_of(shape_.energy),
                                             .constraints = ranged_ ? held_.pins : constraints_of(reader_.get()),
                                             .initial = std::move(begin_with),
                                             .solver = options_.solver,
                                             .queue = q};
            if (shape_.tolerance) how.solve.stopping.gradient_tolerance = *shape_.tolerance;
            dist::session<element> session(all_.raw(), piece, how);
            numbers_.distributed = sent_so_far();
            report_.seconds.distribute = clock_.now() - begin;
            require_not_interrupted();
            tell("deform");
            found = kept.solve(session, [this] { return limits(); });
        }
        report_.seconds.solve = clock_.now() - begin - report_.seconds.distribute;
        report_.run = std::move(found.report);
        x_ = ranged_ ? std::move(found.x) : dist::impl::collected(all_, found.x);
        count_process();
    }

    /// What process 0 has read. shape: that to begin with, if it is not that at rest.
    dist::mesh_piece<element> dealt_piece(points& shape)
    {
        const mesh<element>* m = nullptr;
        all_.together(
            [&]
            {
                if (!first()) return;
                m = &reader_->input->simplices();
                if (!reader_->file.rest.empty() && !shape_.smoothing) shape = reader_->file.points;
            });
        auto piece = dist::impl::dealt<element>(all_, m);
        shape = dist::impl::spread(all_, shape);
        return piece;
    }

    void count_process()
    {
        const auto now = sent_so_far();
        const auto& before = numbers_.distributed;
        numbers_.solved = {now.messages - before.messages, now.bytes - before.bytes, now.reductions - before.reductions,
                           now.exchanges - before.exchanges};
        numbers_.seconds = report_.run.seconds;
        numbers_.processor = processor_seconds();
        numbers_.peak_memory = peak_memory();
        numbers_.device_bytes = report_.run.device_bytes;
        numbers_.own_vertices = report_.run.own_vertices;
        numbers_.halo_vertices = report_.run.halo_vertices;
        numbers_.cells = report_.run.local_cells;
        report_.processes = dist::impl::collected(all_, std::vector{numbers_});
    }

    /// Of process 0. Throws where there is nothing to be written; adds notes.
    void require_shape(const std::vector<std::string>& notes)
    {
        auto& found = report_.run;
        if (!found.flips || code_ == exit_code::no_valid_map || code_ == exit_code::infeasible)
        {
            shown_.finish();
            if (code_ == exit_code::infeasible) throw infeasible_problem(found.reason);
            throw no_valid_map(found.reason.empty() ? "nothing was written" : found.reason);
        }
        found.notes.insert(found.notes.end(), notes.begin(), notes.end());
        if (!shape_.smoothing && report_.pins + report_.springs == 0) found.notes.push_back(nothing_held);
    }

    void write_files(std::vector<io::file_to_write> files)
    {
        write_with_report(std::move(files), report_, named{options_, shape_.stats}, place_, shown_,
                          [&] { report_.seconds.total = clock_.now(); });
    }

    /// All files appear, or none.
    void write()
    {
        report_.seconds.read = numbers_.read;
        if (first()) tell("write");
        if (ranged_) return write_ranges();
        all_.together(
            [&]
            {
                if (!first()) return;
                require_shape(reader_->notes);
                const auto marks = reader_->pins.held();
                std::vector<char> still(x_.size(), 0);
                for (const idx v : reader_->fixed) still[static_cast<std::size_t>(v)] = 1;
                const written_shape<element> written(
                    *reader_->input, x_,
                    [&](std::size_t v, int k)
                    { return shape_.smoothing ? !still[v] : !(v < marks.size() && marks.test(v, k)); });
                if (!written.note.empty()) report_.run.notes.push_back(written.note);
                if (!written.state.simplices) throw no_valid_map(written.defects(*reader_->input));
                report_.after = written.state;
                write_files(io::impl::volume_outputs(shape_.output, reader_->file, written.points));
            });
    }

    /// Each process writes its share; the file gets its name once the report is out.
    void write_ranges()
    {
        all_.together(
            [&]
            {
                if (first()) require_shape(held_.notes);
            });
        report_.after.shapes = dist::impl::piece_shapes(all_, ranged_->at_corners(x_));
        dist::impl::ranged_volume::outputs files;
        writing([&] { files = ranged_->write(shape_.output, x_); });
        all_.together(
            [&]
            {
                if (!first()) return;
                write_files({});
                for (const auto& file : files) writing([&] { file->commit(); });
            });
    }

    /// As write_with_report() wants them.
    struct named
    {
        const mpi_options& options;
        const std::string& stats;
        operator const mpi_options&() const { return options; }
    };

    const dist::impl::communicator& all_;
    const mpi_options& options_;
    const shape_options& shape_;
    const char* place_;
    run_clock clock_;
    progress shown_;
    std::unique_ptr<reader> reader_;                    ///< of process 0, where it has to read all
    std::unique_ptr<dist::impl::ranged_volume> ranged_; ///< else
    ranged_targets held_;                               ///< of what was read by ranges
    mpi_report report_;
    process_numbers numbers_;
    points x_; ///< of the piece, where that was read by ranges, else of all vertices, at process 0
    exit_code code_ = exit_code::valid, stopped_by_ = exit_code::interrupted;
};

} // namespace

exit_code run_shape(const dist::impl::communicator& all, const mpi_options& options, const char* place_of_report,
                    std::chrono::steady_clock::time_point launch)
{
    return collective_run(all, options, place_of_report, run_clock(launch))();
}

} // namespace taut::tools::mpi
