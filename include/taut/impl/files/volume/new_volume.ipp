// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/files.hpp>
#include <taut/impl/files/volume/formats.hpp>
#include <taut/impl/files/volume/plain_mesh.hpp>
#include <taut/volume_file.hpp>

namespace taut::io
{

template <class Element>
void write_volume(const std::filesystem::path& to, const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    const auto format = impl::volume_format_of_name(to);
    const auto as = std::find_if(impl::text_formats.begin(), impl::text_formats.end(),
                                 [&](const impl::text_format& f)
                                 { return f.format == format && format != volume_format::problem; });
    if (as == impl::text_formats.end())
        throw io_error(to.string(), "meshes are written as MEDIT (.mesh), gmsh (.msh), VTK (.vtk) or VTU (.vtu); "
                                    "give a name that ends so");
    auto points = m.points();
    if (!x.empty() && x.size() != points.size())
        throw parameter_error("x", "has " + std::to_string(x.size()) + " positions for " +
                                       std::to_string(points.size()) + " vertices; give one each");
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < Element::dimension; ++k)
        {
            if (!std::isfinite(x[v][k])) throw parameter_error("x", "position " + std::to_string(v) + " is not finite");
            points[v][k] = x[v][k];
        }
    if (Element::dimension == 2)
        for (const vec3& p : points)
            if (p.z != points.front().z)
                throw parameter_error("m", "is a surface in space; write_obj() writes those, and their maps");
    volume_file like;
    like.dimension = Element::dimension;
    cell_block block{Element::dimension == 2 ? cell_kind::triangle : cell_kind::tetrahedron, {}};
    for (const auto& c : m.cells()) block.corners.insert(block.corners.end(), c.begin(), c.end());
    const impl::plain_mesh mesh{like, std::move(points), {}, {std::move(block)}, {}, {}};
    write_file(to, as->text(mesh));
}

template void write_volume(const std::filesystem::path&, const mesh<triangle>&, std::span<const vec2>);
template void write_volume(const std::filesystem::path&, const mesh<tetrahedron>&, std::span<const vec3>);

} // namespace taut::io
