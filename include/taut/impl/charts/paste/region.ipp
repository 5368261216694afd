// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/charts/paste/region.hpp>
#include <taut/paste.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/geodesic_distances.hpp>
#include <taut/impl/charts/paste/surface/face_set.hpp>
#include <taut/impl/core/core/short_number.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

surface_region cut_out(const mesh<triangle>& m, const face_set& set)
{
    auto faces = set.faces();
    if (faces.empty())
        throw region_error(region_error::empty, {}, "the region has no triangle; name some, or a larger radius");
    if (const auto parts = set.first_of_components(); parts.size() > 1)
        throw region_error(region_error::several_components, parts,
                           "the region is no disk: it has " + std::to_string(parts.size()) +
                               " parts; choose triangles that hang together");
    if (auto touching = set.pinched_vertices(); !touching.empty())
    {
        const auto message = "the region is no disk: it touches itself at " + list_ids("vertex", "vertices", touching) +
                             "; add or take away triangles there";
        throw region_error(region_error::pinched, std::move(touching), message);
    }

    std::vector<idx> own(m.points().size(), -1), vertices;
    for (const idx f : faces)
        for (const idx v : m.cells()[static_cast<std::size_t>(f)]) own[static_cast<std::size_t>(v)] = 0;
    std::vector<vec3> points;
    for (std::size_t v = 0; v < own.size(); ++v)
        if (own[v] == 0)
        {
            own[v] = static_cast<idx>(vertices.size());
            vertices.push_back(static_cast<idx>(v));
            points.push_back(m.points()[v]);
        }
    std::vector<mesh<triangle>::cell> cells;
    for (const idx f : faces)
    {
        auto t = m.cells()[static_cast<std::size_t>(f)];
        for (idx& v : t) v = own[static_cast<std::size_t>(v)];
        cells.push_back(t);
    }
    mesh<triangle> surface(std::move(points), std::move(cells));

    auto loops = boundary_loops(surface);
    std::size_t rim = 0;
    for (const auto& loop : loops) rim += loop.size();
    const auto euler = static_cast<long long>(vertices.size()) - static_cast<long long>((3 * faces.size() + rim) / 2) +
                       static_cast<long long>(faces.size());
    const std::string seen = "the region is no disk: it has " +
                             counted(loops.size(), "boundary loop", "boundary loops") +
                             " and the Euler characteristic " + std::to_string(euler);
    if (loops.empty()) throw region_error(region_error::no_boundary, {}, seen + "; choose less than the whole surface");
    if (loops.size() > 1)
    {
        std::vector<idx> first;
        for (const auto& loop : loops) first.push_back(vertices[static_cast<std::size_t>(loop[0])]);
        throw region_error(region_error::several_boundaries, std::move(first),
                           seen + "; choose a smaller region, or close the holes of the surface");
    }
    if (euler != 1) throw region_error(region_error::handles, {}, seen + "; choose a smaller region");
    return {std::move(surface), std::move(vertices), std::move(faces), std::move(loops[0])};
}

void require_in_range(std::span<const idx> ids, idx count, const char* thing, const char* things)
{
    std::vector<idx> beyond;
    for (const idx i : ids)
        if (i < 0 || i >= count) beyond.push_back(i);
    if (beyond.empty()) return;
    const auto message =
        list_ids(thing, things, beyond) + " not there; numbers run from 0 to " + std::to_string(count - 1);
    throw region_error(region_error::out_of_range, std::move(beyond), message);
}

} // namespace taut::impl

namespace taut
{

surface_region region_of_faces(const mesh<triangle>& m, std::span<const idx> faces)
{
    impl::require_in_range(faces, m.cell_count(), "triangle", "triangles");
    const auto sides = impl::facets(m);
    impl::face_set set(m, sides);
    for (const idx f : faces) set.add(f);
    return impl::cut_out(m, set);
}

surface_region geodesic_disk(const mesh<triangle>& m, idx centre, double radius)
{
    impl::require_in_range(std::array{centre}, m.vertex_count(), "vertex", "vertices");
    if (!(radius > 0)) throw parameter_error("radius", "must be positive");
    const impl::csr cells_of = impl::vertex_cells(m);
    const auto distance = impl::geodesic_distances(m, cells_of, std::array{centre}, radius);
    const auto sides = impl::facets(m);
    impl::face_set set(m, sides);
    for (idx f = 0; f < m.cell_count(); ++f)
    {
        const auto& t = m.cells()[static_cast<std::size_t>(f)];
        if (std::all_of(t.begin(), t.end(), [&](idx v) { return distance[static_cast<std::size_t>(v)] <= radius; }))
            set.add(f);
    }
    idx start = -1;
    for (const idx f : cells_of.row(centre))
        if (set.has(f)) start = f;
    if (start < 0)
        throw region_error(region_error::empty, {centre},
                           "no triangle around vertex " + std::to_string(centre) + " is within the radius " +
                               impl::short_number(radius) + "; name a larger one");
    set.keep_component(start);
    set.fill_holes();
    set.smooth_rim(start);
    for (bool changed = true; changed;)
    {
        set.keep_component(start);
        changed = set.fill_holes();
        changed = set.trim_pinches(start) || changed;
    }
    return impl::cut_out(m, set);
}

surface_region region_inside(const mesh<triangle>& m, std::span<const idx> loop)
{
    impl::require_in_range(loop, m.vertex_count(), "vertex", "vertices");
    const auto sides = impl::facets(m);
    std::map<std::array<idx, 2>, idx> side_of;
    for (idx s = 0; s < static_cast<idx>(sides.twin.size()); ++s) side_of.emplace(impl::side_vertices(m, s), s);
    std::vector<idx> barrier;
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
        const std::array<idx, 2> edge{loop[k], loop[(k + 1) % loop.size()]};
        const auto found = side_of.find(edge);
        if (found == side_of.end())
            throw region_error(region_error::not_a_loop, {edge[0], edge[1]},
                               "vertices " + std::to_string(edge[0]) + " and " + std::to_string(edge[1]) +
                                   " of the loop have no edge with the surface to its left; name vertices along edges");
        barrier.push_back(found->second);
    }
    impl::face_set set(m, sides);
    if (!set.flood(barrier))
        throw region_error(region_error::not_a_loop, {loop.begin(), loop.end()},
                           "the loop does not part the surface; choose one that encloses a region");
    return impl::cut_out(m, set);
}

} // namespace taut
