// SPDX-License-Identifier: MIT
#include "volume/volume_drawing.hpp"

#include <algorithm>
#include <cmath>

#include <picture/layout_picture.hpp>
#include <picture/layout_svg.hpp>
#include <picture/side_by_side_svg.hpp>
#include <picture/volume_picture.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>

#include "shared/failure.hpp"
#include "shared/outputs.hpp"
#include "shared/png.hpp"
#include "shared/text_table.hpp"
#include "volume/clip_plane.hpp"

namespace taut::tools
{

namespace
{

std::string census_of(const io::volume_file& file, const drawn_state& state)
{
    return count_cells(file, file.dimension) + ", " + count(state.inverted.size()) + " inverted";
}

std::string note_of(const io::volume_file& file, const drawn_state& state)
{
    std::vector<double> known;
    for (const double d : state.distortion)
        if (std::isfinite(d)) known.push_back(d);
    std::string note = census_of(file, state);
    if (known.empty()) return note;
    const auto rank = [&](double part)
    {
        const auto at = known.begin() + std::lround(part * static_cast<double>(known.size() - 1));
        std::nth_element(known.begin(), at, known.end());
        return number(*at, 3);
    };
    const std::string median = rank(0.5), most = rank(1);
    return note + "; median " + median + ", largest " + most;
}

/// Cells that the plane leaves, by their centres.
std::vector<char> kept_cells(const io::volume_file& file, std::span<const vec3> points,
                             const std::optional<clip_plane>& cut)
{
    std::vector<char> kept;
    io::impl::for_each_cell(file, 3,
                            [&](io::cell_kind, idx, std::span<const idx> corners)
                            {
                                vec3 centre(0.0);
                                for (const idx v : corners)
                                    centre += points[static_cast<std::size_t>(v)] / static_cast<double>(corners.size());
                                kept.push_back(!cut || !cut->beyond(centre));
                            });
    return kept;
}

std::string draw_volumes(const io::volume_file& file, const std::vector<drawn_state>& states,
                         const drawing_options& options)
{
    const auto& places = !file.rest.empty() ? file.rest
                         : options.by_shape ? states.back().points
                                            : states.front().points;
    const auto cut = parse_clip(options.clip, places);
    const auto kept = kept_cells(file, places, cut);
    const auto sides = file.faces();
    const auto is_kept = [&](std::size_t side) { return kept[static_cast<std::size_t>(sides.faces[side].cell)] != 0; };
    std::vector<std::size_t> seen;
    for (std::size_t s = 0; s < sides.faces.size(); ++s)
        if (is_kept(s) && (sides.twin[s] < 0 || !is_kept(static_cast<std::size_t>(sides.twin[s])))) seen.push_back(s);

    std::vector<io::volume_view> views;
    for (const auto& state : states)
    {
        io::volume_view view{state.points, {}, state.title, note_of(file, state)};
        for (const std::size_t s : seen)
        {
            const auto& face = sides.faces[s];
            view.skin.push_back({face.vertices, state.distortion[static_cast<std::size_t>(face.cell)],
                                 std::binary_search(state.inverted.begin(), state.inverted.end(), face.cell)});
        }
        views.push_back(std::move(view));
    }
    io::volume_style style;
    if (cut)
    {
        const vec3 n = glm::normalize(cut->normal);
        if (std::abs(n.z) < 0.9)
            style.stance.front = n;
        else // on it from above, or from below
            style.rise = n.z > 0 ? 50 : -50;
    }
    if (options.by_shape)
    {
        style.scale = "shape";
        style.formula = "1 / mean ratio";
    }
    return encode_png(io::volume_picture(views, style));
}

std::string draw_layouts(const io::volume_file& file, const std::vector<drawn_state>& states,
                         const drawing_options& options)
{
    constexpr int gap = 24;
    std::vector<std::array<idx, 3>> triangles;
    std::vector<std::size_t> owners;
    io::impl::for_each_cell(file, 2,
                            [&](io::cell_kind, idx number, std::span<const idx> corners)
                            {
                                for (std::size_t k = 2; k < corners.size(); ++k)
                                {
                                    triangles.push_back({corners[0], corners[k - 1], corners[k]});
                                    owners.push_back(static_cast<std::size_t>(number));
                                }
                            });
    std::vector<std::vector<idx>> outline;
    for (const auto& [a, b] : impl::boundary_facets(mesh<triangle>(file.points, triangles))) outline.push_back({a, b});
    io::layout_style style;
    style.scale = options.by_shape ? "shape" : "distortion";
    style.formula = options.by_shape ? "1 / mean ratio" : "max(s1, 1/s2)";
    std::vector<std::string> texts;
    std::vector<io::image> images;
    for (const auto& state : states)
    {
        const std::vector<vec2> x(state.points.begin(), state.points.end());
        std::vector<double> distortion;
        for (const std::size_t c : owners) distortion.push_back(state.distortion[c]);
        style.title = state.title;
        style.note = note_of(file, state);
        if (owners.size() > owners.back() + 1) style.census = census_of(file, state);
        if (extension(options.path) == ".svg")
            texts.push_back(io::layout_svg(x, triangles, distortion, outline, style));
        else
            images.push_back(io::layout_picture(x, triangles, distortion, outline, style));
    }
    if (!texts.empty()) return io::side_by_side_svg(texts, style.width, style.height, gap);
    return encode_png(io::side_by_side(images, gap));
}

} // namespace

void require_drawable(const io::volume_file& file, const drawing_options& options)
{
    if (options.path.empty() && !options.clip.empty()) throw usage_error("--clip needs --picture; name one");
    if (file.dimension == 2 && !options.clip.empty())
        throw usage_error("--clip shows the inside of volumes, and this mesh is planar; leave it out");
    if (file.dimension == 3 && extension(options.path) == ".svg")
        throw usage_error("--picture " + options.path + ": pictures of volumes are PNG; name it .png");
    parse_clip(options.clip, file.points);
}

std::string draw_states(const io::volume_file& file, const std::vector<drawn_state>& states,
                        const drawing_options& options)
{
    return file.dimension == 2 ? draw_layouts(file, states, options) : draw_volumes(file, states, options);
}

} // namespace taut::tools
