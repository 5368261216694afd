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
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <atlas/atlas_options.hpp>
#include <atlas/atlas_report.hpp>
#include <atlas/atlas_source.hpp>
#include <atlas/joined_surfaces.hpp>
#include <atlas/part_densities.hpp>
#include <atlas/pinned_faces.hpp>
#include <atlas/seam_edges.hpp>
#include <picture/render_picture.hpp>
#include <picture/symmetric_distortion.hpp>
#include <report/atlas_page.hpp>
#include <taut/atlas.hpp>
#include <taut/charts.hpp>
#include <taut/files.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/charts/atlas/make_atlas.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

#include "commands.hpp"
#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/layout_file.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/png.hpp"
#include "shared/reversed_fans.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

/// Has the allocator keep what is freed for the next phase: getting large arrays from the system anew is a fifth of
/// what an interrupted run still does.
void keep_freed_memory()
{
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);
#endif
}

/// Returns whether pinned corners stay as they are.
bool holds_pinned(const atlas_params& params)
{
    for (std::size_t c = 0; c < params.pinned.size(); ++c)
        if (params.pinned[c] != 0)
            for (const vec2& x : params.initial[c])
                if (params.stored(x) != x) return false;
    return true;
}

/// One run of `taut atlas`, phase by phase.
class atlas_run
{
public:
    atlas_run(const atlas_options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
        : options_(options), command_(options, files, launch)
    {
    }

    exit_code operator()()
    {
        command_.tell("read");
        try
        {
            report_.read = command_.clock.timed([&] { read(); });
            make();
        }
        catch (const mesh_error& e)
        {
            const std::string what = e.what();
            std::string more;
            if (!options_.repair && e.fault() != mesh_error::empty && e.fault() != mesh_error::too_large)
            {
                const bool of_cells =
                    e.fault() == mesh_error::degenerate_cell || e.fault() == mesh_error::repeated_vertex;
                const bool all =
                    of_cells && !sources_.empty() && e.ids().size() == sources_.back()->surface().cells().size();
                more = all ? "; --repair would leave no triangle" : "; --repair repairs it";
                for (const auto& s : sources_)
                    if (!s->near_edges.empty()) more += "; " + s->near_edges;
            }
            const bool named = options_.inputs.size() > 1 || what.starts_with(options_.inputs[0]);
            throw mesh_error(e.fault(), e.ids(), (named ? "" : options_.inputs[0] + ": ") + what + more);
        }
        write();
        return report_.code;
    }

private:
    void read()
    {
        for (std::size_t i = 0; i < options_.inputs.size(); ++i)
        {
            sources_.push_back(open_atlas_source(options_.inputs[i], to_source_options(options_)));
            const auto& s = *sources_.back();
            auto& told = report_.surfaces.emplace_back();
            told.input = options_.inputs[i];
            told.output = options_.outputs[options_.outputs.size() == 1 ? 0 : i];
            told.vertices = s.file_vertices;
            told.triangles = s.file_triangles;
            told.mapped = s.surface().cell_count();
            told.repairs.assign(s.repairs().begin(), s.repairs().end());
            report_.notes.insert(report_.notes.end(), s.notes.begin(), s.notes.end());
            if (!s.near_edges.empty()) report_.notes.push_back(s.near_edges);
            if (!s.texcoord_fault.empty() &&
                (options_.keep_charts() || options_.keep_seams || !options_.pinned.empty()))
                throw unsuitable_input(s.texcoord_fault +
                                       "; correct it, or leave out --charts keep, --keep-seams and --keep-charts");
            if (options_.inputs.size() > 1 || s.is_placed()) require_valid(s.surface(), options_.inputs[i]);
        }
        joined_.emplace(join(sources_));
    }

    /// As make_atlas() does for all surfaces together, with the numbers of one file.
    static void require_valid(const mesh<triangle>& m, const std::string& path)
    {
        try
        {
            validate(m, impl::facets(m), impl::atlas_requirements);
        }
        catch (const mesh_error& e)
        {
            throw mesh_error(e.fault(), e.ids(), path + ": " + e.what());
        }
    }

    void make()
    {
        const auto& m = joined_->surface;
        auto params = to_params(options_);
        const auto f = impl::facets(m);
        params.packing.densities = densities_of(sources_, options_.inputs, options_.densities);
        const auto seams = seams_of(sources_, *joined_, f, options_, params.packing.densities);
        params.charts.seams = seams;
        const auto weights = seam_weights_of(sources_, *joined_, f, options_);
        params.charts.weights = weights;
        const auto diagonals = diagonals_of(sources_, f);
        params.charts.together = diagonals;
        if (options_.keep_charts()) params.initial = texcoords_of(sources_);
        if (options_.by_material)
        {
            auto& groups = params.packing.groups;
            groups = tiles_by_material(*sources_[0]);
            params.packing.tiles = 1 + *std::max_element(groups.begin(), groups.end());
        }
        if (!options_.pinned.empty())
        {
            params.pinned = pinned_of(*sources_[0], f, options_.pinned);
            params.initial = sources_[0]->known_texcoords();
        }
        // The certificate is of what the files will have.
        if (params.origin.y < 0) store_in_gltf(params);
        const auto ask = [this](const taut::progress& p)
        {
            keep(p.usable);
            command_.tell({.phase = p.stage, .step = p.iteration, .energy = p.value});
            return !interrupted();
        };
        command_.tell("device");
        std::optional<queue> q;
        report_.queue = command_.clock.timed([&] { q = open_queue(options_.device, false); });
        report_.device = q->device().name();
        report_.device_label = (std::ostringstream() << q->device()).str();
        const run_limits limits{command_.clock.left(options_.time_limit), ask};
        try
        {
            atlas_ = make_atlas(*q, m, params, limits);
        }
        catch (const symmetry_error& e)
        {
            throw symmetry_error(e.normal(), e.offset(), vertices_of_files(sources_, *joined_, e.vertices()),
                                 e.edges());
        }
        report_.atlas = atlas_->report;
        report_.notes.insert(report_.notes.end(), atlas_->report.notes.begin(), atlas_->report.notes.end());
        if (options_.max_stretch && options_.densities.empty() && atlas_->report.stretch_l2 > *options_.max_stretch)
            report_.notes.push_back("the stretch is " + number(atlas_->report.stretch_l2, 4) +
                                    ", above --max-stretch; `--prefer packing` cuts further");
        if (!atlas_->report.complete) report_.code = interrupted() ? interruption() : exit_code::time_limit;
        if (!*atlas_) throw no_valid_map(atlas_->report.reason + in_files(atlas_->report.reason_triangles));
    }

    /// What the files call triangles of the surface, where they have other numbers.
    std::string in_files(std::span<const idx> triangles) const
    {
        std::string text;
        bool other = sources_.size() > 1;
        for (const idx t : triangles)
        {
            const auto after = std::upper_bound(joined_->first_cell.begin(), joined_->first_cell.end(), t);
            const auto i = static_cast<std::size_t>(after - joined_->first_cell.begin()) - 1;
            const idx own = sources_[i]->cell_origin(t - joined_->first_cell[i]);
            other = other || own != t;
            text += (text.empty() ? "" : ", ") + std::to_string(own);
            if (sources_.size() > 1) text += " of " + options_.inputs[i];
        }
        return other && !text.empty() ? "; as the files number triangles: " + text : std::string();
    }

    /// Texture coordinates are floats, or fractions where these hold what is pinned as it is and floats do not.
    void store_in_gltf(atlas_params& params)
    {
        params.stored = io::gltf_model::stored<io::gltf_model::numbers::floats>;
        if (holds_pinned(params)) return;
        params.stored = io::gltf_model::stored<io::gltf_model::numbers::fractions>;
        numbers_ = io::gltf_model::numbers::fractions;
        if (params.packing.tiles == 1 && holds_pinned(params)) // they end at 1
        {
            params.packing.rounding = std::max(params.packing.rounding, 0.5 / 65535);
            return;
        }
        params.stored = io::gltf_model::stored<io::gltf_model::numbers::floats>;
        numbers_ = io::gltf_model::numbers::floats;
        report_.notes.push_back("coordinates of kept charts are rounded to single precision, as glTF has no other");
    }

    void write()
    {
        keep(true);
        const corner_maps maps(*joined_, *atlas_);
        std::vector<io::file_to_write> files;
        if (options_.outputs.size() < sources_.size())
            files.push_back({options_.outputs[0], [&](io::atomic_file& file)
                             { write_joined(file, options_.inputs, sources_, *joined_, maps); }});
        else
            for (std::size_t i = 0; i < sources_.size(); ++i)
            {
                if (!io::is_gltf(options_.outputs[i])) report_.reversed_fans += sources_[i]->reversed_fans(maps.of(i));
                for (auto& file : sources_[i]->files(options_.outputs[i], maps.of(i), numbers_, report_.notes))
                    files.push_back(std::move(file));
            }
        note_reversed_fans(report_.notes, report_.reversed_fans);
        const auto draw = [&](std::string& path, auto image)
        { add_picture(files, path, report_.notes, command_.clock, report_.draw, image); };
        draw(options_.picture, [this] { return picture(); });
        draw(options_.render, [this] { return render(); });
        draw(options_.report, [this] { return page(); });
        command_.write(std::move(files), report_, options_,
                       [&](double total, double write)
                       {
                           report_.total = total;
                           report_.write = write - report_.draw;
                       });
    }

    std::string title() const
    {
        std::string names;
        for (const auto& input : options_.inputs)
            names += (names.empty() ? "" : ", ") + std::filesystem::path(input).filename().string();
        return names;
    }

    /// The atlas in the squares from 0.
    std::vector<vec2> shown() const
    {
        std::vector<vec2> uv = atlas_->uv;
        for (vec2& x : uv) x -= origin_of(options_);
        return uv;
    }

    /// The same in widths of a tile.
    std::vector<vec2> sized() const
    {
        std::vector<vec2> uv = shown();
        for (vec2& x : uv) x.y *= to_params(options_).packing.aspect;
        return uv;
    }

    std::string picture() const
    {
        const auto& cut = atlas_->charts.surface;
        const auto uv = sized();
        std::vector<vec2> in_units = uv;
        for (vec2& p : in_units) p /= atlas_->layout.scale;
        const auto distortion = io::symmetric_distortion(cut.points(), cut.cells(), in_units);
        const auto loops = boundary_loops(cut);
        const io::layout_style style{.title = title(),
                                     .energy = report_.atlas.distortion,
                                     .note = std::to_string(report_.atlas.charts.size()) + " charts, " +
                                             std::to_string(static_cast<int>(100 * report_.atlas.utilization)) +
                                             " % of the square used"};
        return layout_file(options_.picture, uv, cut.cells(), distortion, loops, style, {});
    }

    std::string render() const
    {
        const auto& cut = atlas_->charts.surface;
        return encode_png(io::render_picture(cut.points(), cut.cells(), sized(), {.title = title()}));
    }

    std::string page() const
    {
        const auto& m = joined_->surface;
        const auto corners = atlas_->corners();
        const auto places = shown();
        std::vector<std::array<vec2, 3>> uv(corners.size());
        for (std::size_t c = 0; c < uv.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k) uv[c][k] = places[static_cast<std::size_t>(corners[c][k])];
        std::vector<idx> chart(corners.size());
        for (std::size_t k = 0; k + 1 < atlas_->charts.first_cell.size(); ++k)
            for (idx c = atlas_->charts.first_cell[k]; c < atlas_->charts.first_cell[k + 1]; ++c)
                chart[static_cast<std::size_t>(atlas_->charts.cell_origins[static_cast<std::size_t>(c)])] =
                    static_cast<idx>(k);
        const auto energy = triangle_energies(*atlas_, to_params(options_).packing.aspect);
        report::atlas_page page{.title = title(),
                                .command = as_command_line(options_),
                                .points = m.points(),
                                .cells = m.cells(),
                                .uv = uv,
                                .chart = chart,
                                .energy = energy,
                                .columns = {},
                                .repairs = {},
                                .stages = stages(report_),
                                .numbers = numbers(report_)};
        for (const auto& s : report_.surfaces)
            for (const auto& finding : s.repairs) page.repairs.push_back(finding.message());
        return atlas_report_html(page);
    }

    atlas_options options_;
    command_run command_;
    std::vector<std::unique_ptr<atlas_source>> sources_;
    std::optional<joined_surfaces> joined_;
    std::optional<atlas> atlas_;
    io::gltf_model::numbers numbers_ = io::gltf_model::numbers::floats;
    atlas_run_report report_;
};

} // namespace

command add_atlas(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<atlas_options>();
    declare(program.add_subcommand("atlas", "Cut any surface into charts, flatten them and pack them in a square"),
            *options);
    return [options, launch](const outputs& files)
    {
        keep_freed_memory();
        return atlas_run(*options, files, launch)();
    };
}

} // namespace taut::tools
