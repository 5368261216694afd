// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include <picture/render_picture.hpp>
#include <picture/symmetric_distortion.hpp>
#include <taut/files.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/parameterize.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#include "commands.hpp"
#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/layout_file.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/png.hpp"
#include "shared/reversed_fans.hpp"
#include "shared/seams.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"
#include "unwrap/unwrap_options.hpp"
#include "unwrap/unwrap_report.hpp"

namespace taut::tools
{

namespace
{

queue open_queue(const unwrap_options& options, std::vector<std::string>& notes)
{
    const bool need = options.precision == precision::fp64 || options.precision == precision::mixed;
    queue q =
        tools::open_queue(options.device, need); // a wish for double or mixed precision needs a device with double
    if (options.precision == precision::automatic && !q.device().has_fp64())
        notes.push_back("the device has no double precision: computed in float");
    return q;
}

/// One run of `taut unwrap`, phase by phase.
class unwrap_run
{
public:
    unwrap_run(const unwrap_options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
        : options_(options), command_(options, files, launch)
    {
    }

    exit_code operator()()
    {
        command_.tell("read");
        report_.seconds.read =
            command_.clock.timed([&] { file_ = io::read_surface_file(options_.input, options_.format); });
        report_.notes = file_->notes;
        try
        {
            cut();
            read_pins();
            parameterize();
        }
        catch (const mesh_error& e)
        {
            throw mesh_error(e.fault(), e.ids(), options_.input + ": " + e.what());
        }
        write();
        return report_.code;
    }

private:
    void cut()
    {
        cut_ = cut_open(*file_, {.one_boundary = !options_.holes}, options_.start == start_kind::uv);
        if (cut_)
            report_.notes.push_back(describe(*cut_));
        else if (options_.cut && (cut_ = cut_to_one_disk(*file_)))
            report_.notes.push_back("cut open along short seams, on which " +
                                    count(cut_->seam_vertices, "vertex lies", "vertices lie"));
    }

    /// Surface to be mapped: that of the file, or that cut open.
    const mesh<triangle>& surface() const { return cut_ ? cut_->surface : file_->surface; }

    void write_obj(io::atomic_file& file, std::span<const vec2> uv) const
    {
        if (cut_)
            io::write_obj(file, *file_, *cut_, uv);
        else
            io::write_obj(file, *file_, uv);
    }

    void read_pins()
    {
        if (options_.pins.empty()) return;
        const auto pins = io::read_pins<2>(options_.pins, file_->surface.vertex_count());
        if (cut_) require_undivided(pins, divided_vertices(*cut_));
        pins_ = constraints<triangle>(surface());
        pins_.add(pins);
        report_.pins = pins_.pins().size();
        report_.springs = pins_.springs().size();
        if (pins.empty()) report_.notes.push_back(options_.pins + ": has no pins; nothing is fixed");
    }

    void parameterize()
    {
        auto params = to_params(options_);
        params.constraints = pins_;
        params.polygons = file_->faces.of_triangles();
        if (options_.start == start_kind::uv) params.initial = start_from_file();
        const auto ask = [this](const taut::progress& p)
        {
            keep(p.usable);
            if (p.iterate)
                command_.tell({.phase = p.level > 0 ? "coarse levels" : "optimize",
                               .step = p.iteration,
                               .most_steps = options_.iterations,
                               .energy = p.value,
                               .gradient = p.gradient,
                               .length = p.step});
            return !interrupted();
        };
        command_.tell("device");
        std::optional<queue> q;
        report_.seconds.queue = command_.clock.timed([&] { q = open_queue(options_, report_.notes); });
        report_.device = q->device().name();
        report_.device_label = (std::ostringstream() << q->device()).str();

        // The limit is one for the whole run: what reading took is gone.
        const run_limits limits{command_.clock.left(options_.time_limit), ask};
        command_.tell("start");
        auto result = taut::parameterize(*q, surface(), params, limits);
        report_.map = std::move(result.report);
        report_.notes.insert(report_.notes.end(), report_.map.notes.begin(), report_.map.notes.end());
        if (params.no_overlap && params.boundary != boundary_mode::free && !params.holes)
            report_.notes.push_back("no triangles overlap on a circle or square: --no-overlap has no effect");
        keep(!result.uv.empty());
        if (!result) refuse(result);
        uv_ = std::move(result.uv);
        const auto polygons =
            impl::find_convex_polygons(surface().cells(), file_->faces.of_triangles(), surface().points());
        command_.tell("measure");
        report_.seconds.quality = command_.clock.timed([&] { report_.assess(options_, params, surface(), uv_); });
        take_polygons(report_.after, polygons, uv_);
        report_.after.reversed_fans = count_reversed_fans(file_->faces, surface(), uv_);
        note_reversed_fans(report_.notes, report_.after.reversed_fans);
        note_unfinished();
        report_.after.vertices = file_->surface.vertex_count();
        report_.seam_vertices = cut_ ? cut_->seam_vertices : 0;
        // The certificate of exactly what is written, taken by other code than the solver's.
        if (!report_.after.quality.flips)
            throw no_valid_map("the map has " + impl::describe_defects<triangle>(report_.after.quality.flips) +
                               "; --precision fp64 may succeed");
    }

    /// A run that ends at the limit of iterations with a map of great distortion is not done.
    void note_unfinished()
    {
        constexpr double great = 1e4; // isometric energy; 4 is an isometry
        const double energy = report_.after.quality.isometric.measure;
        if (report_.map.solve.stop != solve::stop::iterations || !(energy > great)) return;
        report_.notes.push_back("the limit of " +
                                count(static_cast<std::uint64_t>(options_.iterations), "iteration", "iterations") +
                                " ended the run with an isometric energy of " + number(energy) +
                                ", where 4 is an isometry: parts are "
                                "squeezed to almost nothing; " +
                                (options_.holes && !options_.cut ? "--cut in place of --holes opens the surface"
                                                                 : "another --start, or cuts, may do better"));
    }

    /// Never a folded map under the name that was asked for: the best one goes beside it.
    [[noreturn]] void refuse(const map_result& result) const
    {
        const auto& map = report_.map;
        if (map.outcome == outcome::infeasible) throw infeasible_problem(map.reason);
        if (interrupted() && map.outcome != outcome::gave_up) throw interrupted_run("there was no map yet");
        if (map.outcome == outcome::stopped) throw no_valid_map(map.reason);
        if (map.outcome != outcome::gave_up)
            throw no_valid_map(map.reason + (options_.start == start_kind::uv
                                                 ? "; --start tutte makes a map without flips"
                                             : options_.holes && !options_.cut
                                                 ? "; --cut in place of --holes opens the surface, which may succeed"
                                                 : "; --start mean-value or --spacing uniform may succeed"));
        const std::string best = name_of_invalid(options_.output);
        if (!best.empty())
            writing(
                [&]
                {
                    io::atomic_file file(best);
                    write_obj(file, result.uv);
                    file.commit();
                });
        const std::string what = map.reason + (best.empty() ? "" : "; the best map is in " + best);
        if (interrupted()) throw interrupted_run(what);
        throw no_valid_map(what + "; move the pins less far, or make some of them springs");
    }

    std::vector<vec2> start_from_file() const
    {
        if (!file_->texcoord_fault.empty())
            throw unsuitable_input(file_->texcoord_fault + "; correct it for --start uv, or use --start tutte");
        if (file_->texcoords.empty())
            throw unsuitable_input(options_.input +
                                   ": has no texture coordinates (vt) for --start uv; use --start tutte");
        return cut_ ? cut_->uv : file_->vertex_texcoords();
    }

    void write()
    {
        std::vector<io::file_to_write> files{{options_.output, [&](io::atomic_file& file) { write_obj(file, uv_); }}};
        const auto draw = [&](std::string& path, auto image)
        { add_picture(files, path, report_.notes, command_.clock, report_.seconds.draw, image); };
        draw(options_.picture, [this] { return picture(); });
        draw(options_.render, [this] { return render(); });
        command_.write(std::move(files), report_, options_,
                       [&](double total, double write)
                       {
                           report_.seconds.total = total;
                           report_.seconds.write = write - report_.seconds.draw;
                       });
        remove_invalid(options_.output);
    }

    std::string title() const { return std::filesystem::path(options_.input).filename().string(); }

    std::string picture() const
    {
        const auto distortion = io::symmetric_distortion(surface().points(), surface().cells(), uv_);
        const auto loops = boundary_loops(surface());
        const io::layout_style style{.title = title(), .energy = report_.energy, .note = report_.summary()};
        const auto overlay = constraints_overlay();
        return layout_file(options_.picture, uv_, surface().cells(), distortion, loops, style, overlay);
    }

    std::string render() const
    {
        const io::render_style style{.title = title(), .up = options_.up, .front = options_.front};
        return encode_png(io::render_picture(surface().points(), surface().cells(), uv_, style));
    }

    io::layout_overlay constraints_overlay() const
    {
        io::layout_overlay overlay;
        auto origin = report_.map.pin_origins.begin();
        for (const auto& [v, pin] : pins_.pins())
            overlay.pins.push_back({*origin++, uv_[static_cast<std::size_t>(v)], true, pin.held});
        for (const auto& s : pins_.springs())
            overlay.pins.push_back({uv_[static_cast<std::size_t>(s.vertex)], s.target, false});
        return overlay;
    }

    unwrap_options options_;
    command_run command_;
    std::optional<io::surface_file> file_;
    std::optional<io::cut_surface> cut_;
    constraints<triangle> pins_;
    std::vector<vec2> uv_;
    unwrap_report report_;
};

} // namespace

command add_unwrap(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<unwrap_options>();
    const auto app = program.add_subcommand("unwrap", "Flatten a surface with little distortion and without folds");
    declare(app, *options);
    app.footer("exit codes: 0 valid map; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
               "  6 no valid map; 7 proved infeasible; 8 time limit, with a valid map written; 9 device failure;\n"
               "  130 interrupted (Ctrl-C), 143 terminated, with a valid map written if there was one by then");
    return [options, launch](const outputs& files) { return unwrap_run(*options, files, launch)(); };
}

} // namespace taut::tools
