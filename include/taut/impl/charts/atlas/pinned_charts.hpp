// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/certify.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>
#include <taut/pack.hpp>

namespace taut::impl
{

/// Charts of a surface that stay where they are, and the rest of the surface.
class pinned_charts
{
public:
    /// Refers to all; some triangles are pinned. Throws packing_error where pinned charts are invalid.
    pinned_charts(const mesh<triangle>& m, const facet_table& f, const atlas_params& params)
        : mesh_(m),
          params_(params),
          pinned_(part(true, seams_of_map(m, f, params.initial))),
          rest_(part(false, std::vector<char>(f.twin.size(), 0)))
    {
        place();
        certify_places();
    }

    /// Throws parameter_error.
    static void require(const mesh<triangle>& m, const atlas_params& params)
    {
        if (params.pinned.size() != m.cells().size()) throw parameter_error("pinned", "must have one flag a triangle");
        if (params.initial.size() != m.cells().size())
            throw parameter_error("initial", "must have the places of pinned triangles");
        if (std::count(params.pinned.begin(), params.pinned.end(), char(0)) == 0)
            throw parameter_error("pinned", "has all triangles, so that no chart is left to make; pin fewer");
    }

    /// The surface without them.
    const surface_part& rest() const { return rest_; }

    /// Parameters for that surface. seams, together: storage that they refer to
    atlas_params of_rest(std::vector<char>& seams, std::vector<char>& together) const
    {
        atlas_params params = params_;
        params.charts.seams = seams = rest_.by_side(params.charts.seams);
        params.charts.together = together = rest_.by_side(params.charts.together);
        params.pinned.clear();
        params.initial.clear();
        params.packing.groups.clear();
        params.packing.densities.clear();
        for (const idx c : rest_.triangles)
        {
            params.initial.push_back(params_.initial[u(c)]);
            const auto& given = params_.packing;
            if (!given.groups.empty()) params.packing.groups.push_back(given.groups[u(c)]);
            if (!given.densities.empty()) params.packing.densities.push_back(given.densities[u(c)]);
        }
        if (!params_.keeps_charts()) params.initial.clear();
        const auto sides = facets(pinned_.charts.surface);
        for (std::size_t k = 0; k < tiles_.size(); ++k)
            for (idx s = 3 * pinned_.charts.first_cell[k]; s < 3 * pinned_.charts.first_cell[k + 1]; ++s)
            {
                if (sides.twin[u(s)] >= 0) continue;
                const auto [a, b] = side_vertices(pinned_.charts.surface, s);
                params.packing.walls.push_back(
                    {tiles_[k], {uv_[u(a)] - corner(tiles_[k]), uv_[u(b)] - corner(tiles_[k])}});
            }
        return params;
    }

    /// Adds the pinned charts to those of the rest. uv: places of these; pinned: one flag a chart then
    void join(chart_mesh& charts, std::vector<vec2>& uv, packing& layout, std::vector<char>& pinned) const
    {
        std::vector<std::array<idx, 3>> cells = charts.surface.cells();
        for (idx& c : charts.cell_origins) c = rest_.triangles[u(c)];
        const auto vertices = static_cast<idx>(uv.size()), before = static_cast<idx>(cells.size());
        layout.places.resize(u(charts.charts())); // without an atlas of the rest there are none
        pinned.assign(u(charts.charts()), 0);
        pinned.resize(pinned.size() + tiles_.size(), 1);
        for (auto t : pinned_.charts.surface.cells())
        {
            for (idx& v : t) v += vertices;
            cells.push_back(t);
        }
        charts.cell_origins.insert(charts.cell_origins.end(), pinned_.triangles.begin(), pinned_.triangles.end());
        for (std::size_t k = 0; k < tiles_.size(); ++k)
        {
            charts.first_cell.push_back(before + pinned_.charts.first_cell[k + 1]);
            charts.first_vertex.push_back(vertices + pinned_.charts.first_vertex[k + 1]);
            layout.places.push_back({.tile = tiles_[k]});
        }
        layout.utilization += area() / params_.packing.tiles;
        uv.insert(uv.end(), uv_.begin(), uv_.end());
        charts.vertex_origins.assign(uv.size(), 0);
        std::vector<vec3> points(uv.size());
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx v = mesh_.cells()[u(charts.cell_origins[i])][k];
                charts.vertex_origins[u(cells[i][k])] = v;
                points[u(cells[i][k])] = mesh_.points()[u(v)];
            }
        charts.surface = mesh<triangle>(std::move(points), std::move(cells));
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Area of their triangles in the atlas.
    double area() const
    {
        double sum = 0;
        for (const auto& t : pinned_.charts.surface.cells())
            sum += orient(uv_[u(t[0])], uv_[u(t[1])], uv_[u(t[2])]).det / 2;
        return sum;
    }

    vec2 corner(idx tile) const { return params_.origin + vec2(tile % 10, tile / 10); }

    surface_part part(bool pinned, std::span<const char> seam) const
    {
        std::vector<char> wanted;
        for (const char flag : params_.pinned) wanted.push_back((flag != 0) == pinned);
        return part_of(mesh_, wanted, seam);
    }

    void place()
    {
        uv_.resize(pinned_.charts.surface.points().size());
        for (std::size_t i = 0; i < pinned_.triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const vec2& x = params_.initial[u(pinned_.triangles[i])][k];
                uv_[u(pinned_.charts.surface.cells()[i][k])] = params_.stored != nullptr ? params_.stored(x) : x;
            }
        for (idx k = 0; k < pinned_.charts.charts(); ++k)
        {
            vec2 low(std::numeric_limits<double>::infinity()), high = -low;
            for (auto v = u(pinned_.charts.first_vertex[u(k)]); v < u(pinned_.charts.first_vertex[u(k) + 1]); ++v)
            {
                if (!finite(uv_[v])) refuse(k, "has no texture coordinate, or a non-finite one");
                low = glm::min(low, uv_[v]);
                high = glm::max(high, uv_[v]);
            }
            const vec2 square = glm::floor(low / 2.0 + high / 2.0), tile = square - params_.origin;
            const bool inside = tile.x >= 0 && tile.x < 10 && tile.y >= 0 && tile.y < 100 &&
                                10 * tile.y + tile.x < params_.packing.tiles && low.x >= square.x &&
                                low.y >= square.y && high.x <= square.x + 1 && high.y <= square.y + 1;
            if (!inside) refuse(k, "leaves the square");
            tiles_.push_back(static_cast<idx>(10 * tile.y + tile.x));
        }
    }

    void certify_places() const
    {
        const auto& charts = pinned_.charts;
        const auto& cells = charts.surface.cells();
        if (const auto flips = certify<2>(cells, std::span<const vec2>(uv_)); !flips)
            for (idx k = 0; k < charts.charts(); ++k)
            {
                const std::span some(cells.data() + charts.first_cell[u(k)],
                                     cells.data() + charts.first_cell[u(k) + 1]);
                if (!certify<2>(some, std::span<const vec2>(uv_))) refuse(k, "is mirrored or folded");
            }
        const auto crossing = crossing_charts(charts, uv_);
        for (idx k = 0; k < charts.charts(); ++k)
            if (crossing[u(k)]) refuse(k, "overlaps itself");
        const auto overlaps = find_chart_overlaps(uv_, cells, charts.first_cell, charts.first_vertex);
        if (overlaps.pairs > 0)
            refuse(overlaps.first[0], "overlaps that of triangle " +
                                          std::to_string(pinned_.first_triangle(u(overlaps.first[1]))) +
                                          ", which is pinned, too");
    }

    [[noreturn]] void refuse(idx chart, const std::string& why) const
    {
        const idx c = pinned_.first_triangle(u(chart));
        throw packing_error(packing_error::pinned, {c},
                            "the pinned chart of triangle " + std::to_string(c) + ' ' + why + "; do not pin it");
    }

    const mesh<triangle>& mesh_;
    const atlas_params& params_;
    const surface_part pinned_, rest_;
    std::vector<vec2> uv_;   // one per vertex of the pinned charts
    std::vector<idx> tiles_; // of each
};

} // namespace taut::impl
