// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <picture/layout_picture.hpp>
#include <taut/untangle_problem.hpp>
#include <taut/volume_file.hpp>

namespace taut::tools
{

/// One picture of a map in the plane with its pins.
struct layout_input
{
    std::span<const vec2> x;
    io::layout_style style;
};

/// The bytes of a picture; SVG or PNG as the path says.
std::string draw(const std::string& path, const untangle_problem<triangle>& p, const std::vector<layout_input>& maps);

/// A problem as its file would have it, but for the bytes: to draw, or to split.
template <class Element>
io::volume_file file_of(const untangle_problem<Element>& p)
{
    constexpr bool planar = Element::dimension == 2;
    io::volume_file file;
    file.path = "the problem";
    file.format = "problem";
    file.dimension = file.places.per_point = Element::dimension;
    for (const auto& x : p.initial)
        if constexpr (planar)
            file.points.emplace_back(x, 0.0);
        else
            file.points.push_back(x);
    file.rest = p.rest.points();
    file.cells = {{planar ? io::cell_kind::triangle : io::cell_kind::tetrahedron, {}}};
    for (const auto& cell : p.rest.cells())
        file.cells.front().corners.insert(file.cells.front().corners.end(), cell.begin(), cell.end());
    io::volume_group fixed{"fixed", 0, {}};
    for (std::size_t v = 0; v < p.held.size(); ++v)
        if (p.held.all(v)) fixed.vertices.push_back(static_cast<idx>(v));
    file.groups.push_back(std::move(fixed));
    return file;
}

} // namespace taut::tools
