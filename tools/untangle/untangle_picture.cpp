// SPDX-License-Identifier: MIT
#include "untangle/untangle_picture.hpp"

#include <picture/layout_svg.hpp>
#include <picture/side_by_side_svg.hpp>
#include <picture/symmetric_distortion.hpp>
#include <taut/certify.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

#include "shared/outputs.hpp"
#include "shared/png.hpp"

namespace taut::tools
{

namespace
{

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
    for (const auto& [a, b] : impl::boundary_facets(m)) edges.push_back({a, b});
    return edges;
}

} // namespace

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

} // namespace taut::tools
