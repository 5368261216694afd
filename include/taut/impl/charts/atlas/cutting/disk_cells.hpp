// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/chart_start.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// A piece of a surface with a map without flips and overlaps.
struct disk_cell
{
    std::vector<idx> triangles;          ///< of the surface
    std::vector<std::array<vec2, 3>> uv; ///< one per triangle, by corner, in units of the surface
    double energy = 4;                   ///< area mean of the isometric energy
};

/// Divides a surface into Voronoi cells about triangles that are far from each other, in steps from triangle to
/// triangle: few, cheap ones, that exist for any surface, however rough. Each is projected along its mean normal, or
/// mapped to a circle by barycentric coordinates (Tutte 1963, Floater 2003), which never overlaps. Cells without a map
/// are divided again, and those with a bad one where that makes their maps much better.
class cell_growing
{
public:
    static constexpr double kept = 10; ///< energies below this are better than what cells have

    /// keep: one flag per side, borders that no cell crosses, or empty; together: sides that cells do not end at, where
    /// that can be, or empty
    cell_growing(const mesh<triangle>& m, const facet_table& f, std::span<const char> keep,
                 std::span<const char> together)
        : mesh_(m), seam_(keep.begin(), keep.end())
    {
        seam_.resize(f.twin.size(), 0);
        if (!together.empty()) polygon_ = polygons_of(f, together);
    }

    /// wanted: one flag per triangle; size: triangles of a cell, at most; worst: energy of cells that are not divided
    /// again. Cells in the order of the surface.
    std::vector<disk_cell> run(std::span<const char> wanted, idx size, double worst = 6) const
    {
        const surface_part part = part_of(mesh_, wanted, seam_);
        std::vector<piece> pieces; // of the size of cells, nearly, so that they are worked on in parallel
        for (idx k = 0; k < part.charts.charts(); ++k)
        {
            piece whole = piece_of(part.charts, k, part.triangles);
            const idx n = whole.surface.cell_count();
            if (n <= size)
                pieces.push_back(std::move(whole));
            else
                for (piece& one : divided(whole, (n + size - 1) / size)) pieces.push_back(std::move(one));
        }
        std::vector<std::vector<disk_cell>> made(pieces.size());
        parallel_for(
            pieces.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t k = begin; k < end; ++k) add_cells(pieces[k], map_of(pieces[k]), size, worst, made[k]);
            },
            0, 1);
        std::vector<disk_cell> all;
        for (auto& some : made) std::move(some.begin(), some.end(), std::back_inserter(all));
        return all;
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    static constexpr idx parts = 4;              // of a cell that is divided
    static constexpr double good = 6, bad = 100; // energies
    static constexpr idx few = 256, fewest = 16; // triangles that are not divided where they have a map, a bad one
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    struct piece
    {
        mesh<triangle> surface;     // connected, its vertices one a fan of its triangles
        std::vector<idx> triangles; // of the whole surface
    };

    /// A map of a piece: one point a vertex, and its energy; infinite: there is none.
    struct piece_map
    {
        std::vector<vec2> uv;
        double energy = infinite;
    };

    static piece piece_of(const chart_mesh& charts, idx k, std::span<const idx> triangles)
    {
        return {chart_alone(charts, u(k)), std::vector<idx>(triangles.begin() + charts.first_cell[u(k)],
                                                            triangles.begin() + charts.first_cell[u(k) + 1])};
    }

    /// The best of the maps that cost little.
    static piece_map map_of(const piece& p)
    {
        piece_map made;
        try
        {
            if (p.triangles.size() == 1) // as it is: needles have no map to begin with
            {
                const auto x = p.surface.rest(0);
                const mat2 W = stiff_ideal(x[1] - x[0], x[2] - x[0]);
                made.uv.resize(3);
                for (std::size_t j = 1; j < 3; ++j) made.uv[u(p.surface.cells()[0][j])] = W[static_cast<int>(j) - 1];
                made.uv[u(p.surface.cells()[0][0])] = vec2(0.0);
                return {std::move(made.uv), 4};
            }
            const chart_mesh alone{p.surface, {0, p.surface.cell_count()}, {0, p.surface.vertex_count()}, {}, {}};
            const auto [surface, unit] = single_chart::of(alone, 0);
            const ideal_elements<triangle> ideal(surface);
            const auto consider = [&, unit = unit](chart_start start)
            {
                if (start.uv.empty() || overlaps_itself(alone, 0, start.uv)) return;
                made.energy = start.energy;
                for (vec2& x : start.uv) x /= unit;
                made.uv = std::move(start.uv);
            };
            chart_start seen, round;
            seen.consider(surface, ideal, projected(surface));
            consider(std::move(seen));
            if (made.energy < good) return made;
            const auto f = facets(surface);
            validate(surface, f, {.referenced = false, .one_boundary = false});
            round.energy = made.energy;
            round.consider(surface, ideal, barycentric_map(surface, f, {.stretch_rounds = 1}).uv);
            consider(std::move(round));
        }
        catch (const error&)
        {
        }
        return made;
    }

    /// Adds the cells of a piece, whose map this is.
    void add_cells(const piece& p, const piece_map& made, idx size, double worst, std::vector<disk_cell>& cells) const
    {
        const auto n = static_cast<idx>(p.triangles.size());
        if (made.energy < worst || (made.energy < infinite && n <= (made.energy < bad ? few : fewest)))
        {
            add_cell(p, made, cells);
            return;
        }
        const auto smaller = divided(p, std::min(n, std::max(parts, (n + size - 1) / size)));
        std::vector<piece_map> maps;
        double excess = 0, area = 0;
        for (const piece& one : smaller)
        {
            maps.push_back(map_of(one));
            const double own = area_of(one.surface, 0, one.surface.cell_count());
            excess += own * (std::min(maps.back().energy, made.energy) - 4);
            area += own;
        }
        constexpr double gain = 0.5;
        if (made.energy < infinite && !(excess < gain * area * (made.energy - 4)))
        {
            add_cell(p, made, cells);
            return;
        }
        for (std::size_t k = 0; k < smaller.size(); ++k) add_cells(smaller[k], maps[k], size, worst, cells);
    }

    static void add_cell(const piece& p, const piece_map& made, std::vector<disk_cell>& cells)
    {
        cells.push_back({p.triangles, {}, made.energy});
        for (const auto& t : p.surface.cells())
            cells.back().uv.push_back({made.uv[u(t[0])], made.uv[u(t[1])], made.uv[u(t[2])]});
    }

    /// So many cells of a piece, each about the triangle that is farthest from those before.
    std::vector<piece> divided(const piece& p, idx count) const
    {
        const auto f = facets(p.surface);
        constexpr idx far = std::numeric_limits<idx>::max();
        std::vector<idx> distance(p.triangles.size(), far), label(p.triangles.size(), 0), seeds;
        const auto spread = [&](std::vector<idx> front)
        {
            for (std::size_t i = 0; i < front.size(); ++i)
                for (idx s = 3 * front[i]; s < 3 * front[i] + 3; ++s)
                {
                    const idx next = f.twin[u(s)] / 3;
                    if (f.twin[u(s)] < 0 || distance[u(next)] <= distance[u(front[i])] + 1) continue;
                    distance[u(next)] = distance[u(front[i])] + 1;
                    label[u(next)] = label[u(front[i])];
                    front.push_back(next);
                }
        };
        const auto sow = [&]
        {
            const auto seed = std::max_element(distance.begin(), distance.end()) - distance.begin();
            seeds.push_back(static_cast<idx>(seed));
            distance[u(seeds.back())] = 0;
            spread({seeds.back()});
        };
        sow(); // anywhere: the next is at an end
        sow();
        seeds.erase(seeds.begin());
        std::fill(distance.begin(), distance.end(), far);
        distance[u(seeds.front())] = 0;
        spread(seeds);
        while (static_cast<idx>(seeds.size()) < count) sow();
        std::fill(distance.begin(), distance.end(), far); // all at once, so that each cell is connected
        for (std::size_t own = 0; own < seeds.size(); ++own)
        {
            distance[u(seeds[own])] = 0;
            label[u(seeds[own])] = static_cast<idx>(own);
        }
        spread(seeds);
        const auto whole = with_polygons(p.triangles, label);
        if (std::any_of(whole.begin(), whole.end(), [&](idx own) { return own != whole.front(); })) label = whole;
        const auto charts = cut_charts(p.surface, f, seams_between(f, label));
        std::vector<idx> triangles;
        for (const idx c : charts.cell_origins) triangles.push_back(p.triangles[u(c)]);
        std::vector<piece> pieces;
        for (idx k = 0; k < charts.charts(); ++k) pieces.push_back(piece_of(charts, k, triangles));
        return pieces;
    }

    /// Labels of triangles of the surface, with those of a polygon alike.
    std::vector<idx> with_polygons(std::span<const idx> triangles, std::vector<idx> label) const
    {
        if (polygon_.empty()) return label;
        std::vector<std::pair<idx, idx>> first; // polygon, place: sorted, so that the first of each is found
        for (std::size_t i = 0; i < label.size(); ++i)
            first.emplace_back(polygon_[u(triangles[i])], static_cast<idx>(i));
        std::sort(first.begin(), first.end());
        for (std::size_t k = 1; k < first.size(); ++k)
            if (first[k].first == first[k - 1].first) label[u(first[k].second)] = label[u(first[k - 1].second)];
        return label;
    }

    const mesh<triangle>& mesh_;
    std::vector<char> seam_;   // one per side
    std::vector<idx> polygon_; // one per triangle; empty: all are triangles
};

} // namespace taut::impl
