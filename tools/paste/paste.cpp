// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <picture/render_picture.hpp>
#include <taut/files.hpp>
#include <taut/impl/charts/paste/surface/surface_tree.hpp>
#include <taut/impl/charts/paste/write_feature_map.hpp>
#include <taut/impl/charts/paste/write_paste.hpp>
#include <taut/surface_file.hpp>

#include "commands.hpp"
#include "paste/face_list.hpp"
#include "paste/paste_check.hpp"
#include "shared/command_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/open_queue.hpp"
#include "shared/outputs.hpp"
#include "shared/peak_memory.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

struct paste_options
{
    std::string source, target, region, output, map, stats, picture, render, device;
    int at = -1, onto = -1, triangles = 0;
    std::optional<int> texels;
    double radius = 0, degrees = 0, reach = paste_params{}.reach;
    paste_pose pose;
    double time_limit = std::numeric_limits<double>::infinity();
    bool quiet = false;
};

/// Throws usage_error.
void check(const paste_options& options)
{
    if (options.region.empty() == (options.at < 0 || !(options.radius > 0)))
        throw usage_error("define the feature: --at V --radius R, or --region FILE, and not both");
    if (options.texels && options.map.empty() && options.triangles == 0)
        throw usage_error(
            "--resolution is the size of a map, and none is made; add --map or --triangles, or leave it out");
}

/// One run of `taut paste`.
class paste_run
{
public:
    paste_run(const paste_options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
        : options_(options), command_(options, files, launch)
    {
    }

    exit_code operator()()
    {
        read_seconds_ = command_.clock.timed(
            [&]
            {
                source_.emplace(io::read_surface_file(options_.source));
                target_.emplace(io::read_surface_file(options_.target));
            });
        for (const auto* file : {&*source_, &*target_}) // faces that stay keep theirs
            if (!file->texcoord_fault.empty())
                throw unsuitable_input(file->texcoord_fault + "; correct it, or leave the texture coordinates out");
        const auto& surface = source_->surface;
        if (options_.region.empty()) require_vertex("--at", options_.at, surface, options_.source);
        require_vertex("--onto", options_.onto, target_->surface, options_.target);
        feature part = feature(options_.region.empty() ? geodesic_disk(surface, options_.at, options_.radius)
                                                       : region_of_faces(surface, read_faces(options_.region)));
        region_ = part.region.vertices;
        std::optional<queue> q;
        device_seconds_ = command_.clock.timed([&] { q = open_queue(options_.device, false); });
        device_ = q->device().name();
        paste_params params{.pose = options_.pose, .reach = options_.reach};
        params.pose.turn = std::remainder(options_.degrees, 360) * std::numbers::pi / 180;
        const double softness = std::exchange(params.pose.softness, 0);
        paste_seconds_ = command_.clock.timed(
            [&]
            {
                paste_.emplace(*q, target_->surface, std::move(part), options_.onto, params);
                soften(softness);
            });
        if (!options_.map.empty() || options_.triangles > 0) map_seconds_ = command_.clock.timed([&] { draw_map(*q); });
        paste_->unfold(); // what is left of folds is told
        quality_ = require_sound(*paste_);
        meeting_ = paste_->self_intersections();
        write();
        return exit_code::valid;
    }

private:
    static void require_vertex(const std::string& option, idx vertex, const mesh<triangle>& m, const std::string& path)
    {
        if (vertex < m.vertex_count()) return;
        throw unsuitable_input(option + ' ' + std::to_string(vertex) + ": " + path + " has vertices 0 to " +
                               std::to_string(m.vertex_count() - 1));
    }

    /// Changes the softness, if the feature has a map.
    void soften(double softness)
    {
        if (softness == 0) return;
        paste_pose to = paste_->pose();
        to.softness = softness;
        try
        {
            paste_->pose(to);
        }
        catch (const paste_error&) // the report tells which softness it has
        {
        }
    }

    /// The feature's map, and its tessellation if that is asked for.
    void draw_map(queue& q)
    {
        const auto uv = paste_->parameterize_feature(q);
        if (!uv) throw no_valid_map("the feature has no map with its rim where it meets the target: " + uv.reason());
        map_ = paste_->part().rasterize(q, uv.uv, options_.texels.value_or(512));
        if (options_.triangles == 0) return;
        const auto before = paste_->part().region.surface;
        paste_->refill(paste_->part().tessellate(q, *map_, uv.uv, options_.triangles));
        const auto& after = paste_->part().region.surface;
        note_triangles(after.cell_count());
        distance_ = std::max(largest_distance(before, after), largest_distance(after, before));
    }

    /// Notes a tessellation that is far from the number of triangles that was asked for, and why.
    void note_triangles(idx made)
    {
        constexpr double near = 0.8;
        const bool fewer = made < near * options_.triangles;
        if (!fewer && options_.triangles >= near * made) return;
        tessellation_note_ = "--triangles " + std::to_string(options_.triangles) + ": " +
                             count(static_cast<std::uint64_t>(made), "triangle", "triangles") + ", as " +
                             (fewer ? "the map has no more detail; give more --resolution"
                                    : "the rim and the shape within need that many");
    }

    /// Largest distance of corners, middles of edges and centroids of one surface from another one.
    static double largest_distance(const mesh<triangle>& from, const mesh<triangle>& to)
    {
        const taut::impl::surface_tree tree(to.points(), to.cells());
        double largest = 0;
        for (idx f = 0; f < from.cell_count(); ++f)
        {
            const auto x = from.rest(f);
            for (const vec3& p : {x[0], x[1], x[2], (x[0] + x[1]) / 2.0, (x[1] + x[2]) / 2.0, (x[2] + x[0]) / 2.0,
                                  (x[0] + x[1] + x[2]) / 3.0})
                largest = std::max(largest, tree.nearest(p).distance);
        }
        return largest;
    }

    /// The map as an image, x, y and z from their smallest to their largest values as red, green and blue.
    std::string preview() const
    {
        const auto& map = *map_;
        vec3 low(std::numeric_limits<double>::infinity()), high = -low;
        const auto at = [&](idx i, idx j)
        {
            const float* v = &map.values[4 * static_cast<std::size_t>(j * map.width + i)];
            return vec3(double(v[0]), double(v[1]), double(v[2]));
        };
        for (idx j = 0; j < map.height; ++j)
            for (idx i = 0; i < map.width; ++i)
                if (map.covers(i, j)) low = glm::min(low, at(i, j)), high = glm::max(high, at(i, j));
        io::image picture(map.width, map.height, {255, 255, 255});
        for (idx j = 0; j < map.height; ++j)
            for (idx i = 0; i < map.width; ++i)
            {
                if (!map.covers(i, j)) continue;
                const vec3 c = 255.0 * (at(i, j) - low) / glm::max(high - low, vec3(1e-300));
                picture(i, map.height - 1 - j) = {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y),
                                                  static_cast<std::uint8_t>(c.z)};
            }
        return encode_png(picture);
    }

    void write()
    {
        std::vector<io::file_to_write> files{
            {options_.output, [&](io::atomic_file& file) { paste_->write(file, *target_, *source_); }}};
        if (!options_.map.empty())
            files.push_back({options_.map, [&](io::atomic_file& file)
                             { file.write(extension(options_.map) == ".png" ? preview() : map_->exr()); }});
        if (!options_.picture.empty())
            files.push_back({options_.picture, [&](io::atomic_file& file) { file.write(picture()); }});
        if (!options_.render.empty())
            files.push_back({options_.render, [&](io::atomic_file& file) { file.write(render()); }});
        command_.write(std::move(files), *this, options_, [&](double total, double) { total_seconds_ = total; });
    }

    /// The vertices of the feature in the result: its last ones.
    std::vector<idx> feature_vertices() const
    {
        std::vector<idx> vertices(static_cast<std::size_t>(paste_->part().region.surface.vertex_count()));
        std::iota(vertices.begin(), vertices.end(), static_cast<idx>(paste_->points().size() - vertices.size()));
        return vertices;
    }

    /// Direction of the feature in the result.
    vec3 feature_front() const { return paste_->transform().rotation * paste_->part().normal; }

    vec3 up_of_target() const { return io::guess_orientation(target_->surface.points(), target_->surface.cells()).up; }

    /// Source, target and result side by side, as who looks at the feature sees them; the feature in checks.
    std::string picture() const
    {
        const vec3 normal = paste_->part().normal, front = feature_front(), up = up_of_target();
        const auto source_up = io::guess_orientation(source_->surface.points(), source_->surface.cells()).up;
        const auto seen_by_viewer = [](const io::image& both)
        {
            io::image one(both.width() / 2, both.height());
            for (int y = 0; y < one.height(); ++y)
                for (int x = 0; x < one.width(); ++x) one(x, y) = both(x, y);
            return one;
        };
        return encode_png(
            io::side_by_side({seen_by_viewer(views(source_->surface, region_, normal, source_up, options_.source)),
                              seen_by_viewer(views(target_->surface, {}, front, up, options_.target)),
                              seen_by_viewer(views(paste_->surface(), feature_vertices(), front, up, "result"))}));
    }

    /// The result, from where the feature is seen and from behind; the feature in checks.
    std::string render() const
    {
        const auto title = std::filesystem::path(options_.output).filename().string();
        return encode_png(views(paste_->surface(), feature_vertices(), feature_front(), up_of_target(), title));
    }

    /// A surface from the front and from behind; marked: vertices between which triangles have checks.
    static io::image views(const mesh<triangle>& m, const std::vector<idx>& marked, const vec3& front, vec3 up,
                           const std::string& title)
    {
        if (std::abs(glm::dot(up, front)) > 0.8) up = std::abs(front.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        const vec3 right = glm::normalize(glm::cross(up, front)), above = glm::cross(front, right);
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        std::vector<vec2> uv(m.points().size(), vec2(none));
        for (const idx v : marked)
        {
            if (v < 0) continue; // the middle of an edge, which the source does not have
            const vec3& p = m.points()[static_cast<std::size_t>(v)];
            uv[static_cast<std::size_t>(v)] = {glm::dot(p, right), glm::dot(p, above)};
        }
        return io::render_picture(m.points(), m.cells(), uv, {.title = title, .checks = 16, .up = up, .front = front});
    }

    nlohmann::ordered_json json() const
    {
        const auto& r = paste_->report();
        const auto& s = r.seconds;
        nlohmann::ordered_json json;
        json["schema"] = "taut.paste/1";
        json["source"] = options_.source;
        json["target"] = options_.target;
        json["output"] = options_.output;
        json["device"] = device_;
        json["source_triangles"] = source_->surface.cell_count();
        json["target_triangles"] = target_->surface.cell_count();
        json["vertices"] = paste_->points().size();
        json["triangles"] = paste_->cells().size();
        json["feature_triangles"] = r.feature_triangles;
        json["rim_vertices"] = paste_->part().region.rim.size();
        json["rim_radius"] = paste_->part().radius;
        json["removed_triangles"] = r.removed_triangles;
        json["gap_triangles"] = r.gap_triangles;
        json["bent_vertices"] = r.bent_vertices;
        json["softness"] = paste_->pose().softness;
        json["softness_asked"] = options_.pose.softness;
        json["correspondence"] = r.way;
        json["controls"] = r.controls;
        json["reciprocal_condition"] = r.reciprocal_condition;
        if (map_)
            json["map"] = {{"width", map_->width},
                           {"height", map_->height},
                           {"footprint", map_->footprint},
                           {"round_trip", map_->round_trip},
                           {"round_trip_rms", map_->round_trip_rms},
                           {"distance", distance_}};
        json["manifold"] = quality_.manifold;
        json["boundary_edges"] = quality_.boundary_edges;
        json["degenerate_triangles"] = quality_.degenerate;
        json["folded_edges"] = quality_.folded;
        json["self_intersections"] = meeting_.size();
        const auto listed = std::min<std::size_t>(meeting_.size(), 100);
        json["self_intersecting_triangles"] =
            std::vector(meeting_.begin(), meeting_.begin() + static_cast<std::ptrdiff_t>(listed));
        json["smallest_gap_angle"] = quality_.smallest_angle;
        json["rim_angle_median"] = quality_.median_angle;
        json["rim_angle_largest"] = quality_.largest_angle;
        json["seconds"] = {{"read", read_seconds_},   {"device", device_seconds_},
                           {"region", s.region},      {"map", s.map},
                           {"land", s.land},          {"seam", s.seam},
                           {"factor", s.factor},      {"transform", s.transform},
                           {"paste", paste_seconds_}, {"feature_map", map_seconds_},
                           {"total", total_seconds_}};
        json["peak_memory_bytes"] = peak_memory();
        return json;
    }

    std::string text() const
    {
        const auto& r = paste_->report();
        const auto triangles = [](auto n) { return count(static_cast<std::uint64_t>(n), "triangle", "triangles"); };
        labelled_lines lines;
        lines.add("feature", options_.source + ": " + triangles(r.feature_triangles) + ", rim of " +
                                 count(paste_->part().region.rim.size(), "vertex", "vertices"));
        lines.add("target", options_.target + ": " + triangles(target_->surface.cell_count()) + ", " +
                                triangles(r.removed_triangles) + " replaced, rim " + r.way);
        lines.add("device", device_);
        lines.add("result",
                  triangles(paste_->cells().size()) + ", manifold, " +
                      count(static_cast<std::uint64_t>(quality_.boundary_edges), "boundary edge", "boundary edges"));
        lines.add("seam", "angle " + number(quality_.median_angle, 3) + " degrees (median), " +
                              number(quality_.largest_angle, 3) + " at most");
        if (const double taken = paste_->pose().softness; taken != options_.pose.softness)
            lines.add("note", "softness " + number(taken, 3) + " instead of " + number(options_.pose.softness, 3) +
                                  ", at which the seam would fold, or which finds no map");
        for (const auto& [file, path] :
             {std::pair(&*source_, &options_.source), std::pair(&*target_, &options_.target)})
            for (const auto& note : file->notes) lines.add("note", *path + ": " + note);
        if (!tessellation_note_.empty()) lines.add("note", tessellation_note_);
        for (const auto& note : notes_of(quality_, meeting_)) lines.add("note", note);
        lines.add("time", duration(total_seconds_) + ": read " + duration(read_seconds_) + ", device " +
                              duration(device_seconds_) + ", paste " + duration(paste_seconds_));
        lines.add_written({options_.output, options_.map, options_.picture, options_.render, options_.stats});
        return (std::ostringstream() << lines).str();
    }

    const paste_options& options_;
    command_run command_;
    std::optional<io::surface_file> source_, target_;
    std::vector<idx> region_; ///< vertices of the source that the feature has
    std::optional<paste> paste_;
    std::optional<impl::feature_map> map_;
    impl::seam_quality quality_;
    std::vector<std::array<idx, 2>> meeting_; ///< triangles of the result, which did not in what it is made of
    std::string device_;
    std::string tessellation_note_;
    double distance_ = 0; ///< of the tessellation from the feature, in units of the source
    double read_seconds_ = 0, device_seconds_ = 0, paste_seconds_ = 0, map_seconds_ = 0, total_seconds_ = 0;

    /// As command_run::write() asks for them.
    friend nlohmann::ordered_json to_json(const paste_run& run, const paste_options&) { return run.json(); }
    friend std::string text_of(const paste_run& run, const paste_options&) { return run.text(); }
};

} // namespace

command add_paste(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<paste_options>();
    const auto app = program.add_subcommand("paste", "Cut a feature out of one surface and paste it on another");
    const auto positive = number_that([](double x) { return x > 0 && std::isfinite(x); }, "is not positive");
    add_input(app, "--source", options->source, "the source", "Surface with the feature: OBJ, OFF, PLY or STL")
        .required();
    app.add_option("--at", options->at, "Vertex of the source at the centre of the feature, from 0")
        .type_name("V")
        .check(whole_number());
    app.add_option("--radius", options->radius, "Geodesic radius of the feature, in units of the source")
        .type_name("R")
        .check(positive);
    add_input(app, "--region", options->region, "the file of triangles",
              "Triangles of the source, from 0, that are the feature, instead of --at and "
              "--radius");
    add_input(app, "--target", options->target, "the target", "Surface to paste it on").required();
    app.add_option("--onto", options->onto, "Vertex of the target at the centre of the rim, from 0")
        .required()
        .type_name("V")
        .check(whole_number());
    app.add_option("--rotate", options->degrees, "Rotate the feature about the normal of the target, counter-clockwise")
        .type_name("DEGREES")
        .check(number_that([](double x) { return std::isfinite(x); }, "is no angle"));
    app.add_option("--scale", options->pose.scale,
                   "Scale of the feature: lengths in the result divided by lengths in the source")
        .type_name("S")
        .check(positive);
    app.add_option("--softness", options->pose.softness,
                   "Softness: 0: the feature keeps its shape, the target bends; 1: its rim is "
                   "projected to the target, the feature bends")
        .type_name("0..1")
        .check(number_that([](double x) { return x >= 0 && x <= 1; }, "is not from 0 to 1"));
    app.add_option("--reach", options->reach,
                   "Radius of the region of the target that may bend, relative to that of the "
                   "feature")
        .type_name("1.2..")
        .check(number_that([](double x) { return x >= 1.2 && std::isfinite(x); }, "is not 1.2 or more"));
    add_output(app, "-o,--output", options->output, {.extensions = {".obj"}}, "Surface to write; - is standard output")
        .required()
        .type_name("OUT.obj");
    app.add_option(
           "--triangles", options->triangles,
           "Remesh the feature from its map, with about this many triangles, or fewer if the map has no more detail")
        .type_name("N")
        .check_range(1, 100'000'000);
    add_output(app, "--map", options->map, {.extensions = {".exr", ".png"}},
               "Write the feature's map of positions: .exr floats, .png colours");
    app.add_option("--resolution", options->texels, "Texels along the longer side of the map")
        .type_name("8..8192")
        .check_range(8, 8192);
    app.rename("--texels", "--resolution");
    add_stats(app, options->stats);
    add_output(app, "--picture", options->picture, {.extensions = {".png"}}, "Draw source, target and result");
    add_output(app, "--render", options->render, {.extensions = {".png"}},
               "Draw the result from both sides, with a checkerboard on the feature");
    add_time_limit(app, options->time_limit, "Give up after S seconds");
    add_device(app, options->device);
    app.add_flag("--quiet", options->quiet, "Print errors only");
    app.rename("-q", "--quiet");
    app.footer("exit codes: 0 written; 2 usage; 3 unreadable input; 4 unsuitable input: no disk, or no place for it;\n"
               "  5 no device; 6 out of time; 9 device failure; 130 interrupted, 143 terminated");
    return [options, launch](const outputs& files) { return paste_run(*options, files, launch)(); };
}

} // namespace taut::tools
