// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/core/mesh/unused_vertices.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
{

/// Notes vertices without a triangle, and moves those with non-finite coordinates to the position of another vertex.
inline void ignore_unused_vertices(surface_soup& soup)
{
    auto unused = taut::impl::unused_vertices(soup.points.size(), soup.triangles);
    if (unused.empty() || soup.triangles.empty()) return;
    soup.notes.push_back(taut::impl::describe_unused(unused));
    std::erase_if(unused,
                  [&](idx v)
                  {
                      const vec3& p = soup.points[static_cast<std::size_t>(v)];
                      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
                  });
    const idx first = soup.triangles[0][0];
    if (first < 0 || static_cast<std::size_t>(first) >= soup.points.size()) return;
    taut::impl::set_aside(std::span<const idx>(unused), soup.triangles, soup.points);
}

/// Makes the surface of valid triangles. path: named in errors. Throws `fault`, or mesh_error as mesh does.
inline surface_file to_surface_file(surface_soup&& soup, const std::string& path)
{
    if (soup.fault) throw mesh_error(*soup.fault);
    ignore_unused_vertices(soup);
    try
    {
        return {mesh<triangle>(std::move(soup.points), std::move(soup.triangles)),
                std::move(soup.texcoords),
                std::move(soup.texcoord_cells),
                std::move(soup.notes),
                std::move(soup.faces),
                std::move(soup.vertices),
                std::move(soup.obj),
                std::move(soup.texcoord_fault)};
    }
    catch (const mesh_error& e)
    {
        throw mesh_error(e.fault(), e.ids(), path + ": " + e.what());
    }
}

} // namespace taut::io::impl
