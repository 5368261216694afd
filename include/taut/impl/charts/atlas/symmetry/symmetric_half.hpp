// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>

namespace taut::impl
{

/// Half of a symmetric surface, with the polygons across the plane. Its charts determine those of the whole: charts of
/// the half have images, and polygons across the plane are in charts of their own.
class symmetric_half
{
public:
    /// Refers to all.
    symmetric_half(const mesh<triangle>& m, const facet_table& f, const mirror_symmetry& mirror)
        : mesh_(m), facets_(f), mirror_(mirror), of_(sides_of_plane()), part_(part()), place_(m.cells().size(), -1)
    {
        for (std::size_t i = 0; i < part_.triangles.size(); ++i) place_[u(part_.triangles[i])] = static_cast<idx>(i);
    }

    const mesh<triangle>& surface() const { return part_.charts.surface; }

    /// Parameters for the half. seams, together: storage that they refer to
    atlas_params params(const atlas_params& of_whole, std::vector<char>& seams, std::vector<char>& together) const
    {
        atlas_params params = of_whole;
        params.symmetric = false;
        const auto &given = params.charts.seams, &inner = params.charts.together;
        seams.assign(3 * part_.triangles.size(), 0);
        together = part_.by_side(inner);
        for (std::size_t i = 0; i < seams.size(); ++i)
        {
            const std::size_t s = part_.origin(i);
            const idx image = mirror_.side[s];
            seams[i] = parts(s) || (!given.empty() && (given[s] != 0 || (image >= 0 && given[u(image)] != 0)));
        }
        params.charts.seams = seams;
        params.charts.together = together;
        return params;
    }

    /// Seams of the whole surface: those of the half, their images, and the border of the half. One flag per side.
    std::vector<char> seams(std::span<const char> of_half) const
    {
        std::vector<char> seam(facets_.twin.size(), 0);
        for (std::size_t s = 0; s < seam.size(); ++s)
        {
            if (facets_.twin[s] < 0) continue;
            const idx own = of_[s / 3] < 0 ? mirror_.side[s] : static_cast<idx>(s);
            seam[s] = parts(s) || (own >= 0 && of_half[3 * u(place_[u(own) / 3]) + u(own) % 3] != 0);
        }
        return seam;
    }

    /// Calls take(corner of the whole, corner of the half, whether it is its image) for all corners of the whole.
    template <class Take>
    void for_each_corner(Take&& take) const
    {
        for (std::size_t s = 0; s < facets_.twin.size(); ++s)
        {
            const bool mirrored = of_[s / 3] < 0;
            const auto own = mirrored ? u(mirror_.corner(mesh_, static_cast<idx>(s / 3), static_cast<idx>(s % 3))) : s;
            take(s, 3 * u(place_[own / 3]) + own % 3, mirrored);
        }
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// One per triangle: 1 in the half, -1 in its image, 0 across the plane.
    std::vector<signed char> sides_of_plane() const
    {
        std::vector<double> above(mirror_.image.size(), 0); // of polygons
        for (std::size_t c = 0; c < mesh_.cells().size(); ++c)
            for (const vec3& x : mesh_.rest(static_cast<idx>(c)))
                above[u(mirror_.polygon[c])] += glm::dot(mirror_.normal, x) - mirror_.offset;
        std::vector<signed char> side(mesh_.cells().size());
        for (std::size_t c = 0; c < side.size(); ++c)
        {
            const auto p = u(mirror_.polygon[c]), q = u(mirror_.image[p]);
            side[c] = p == q ? 0 : above[p] > above[q] || (above[p] == above[q] && p < q) ? 1 : -1;
        }
        return side;
    }

    /// Returns whether the half, its image and the polygons across the plane meet at a side.
    bool parts(std::size_t s) const { return facets_.twin[s] >= 0 && of_[s / 3] != of_[u(facets_.twin[s]) / 3]; }

    surface_part part() const
    {
        std::vector<char> wanted;
        for (const signed char side : of_) wanted.push_back(side >= 0);
        return part_of(mesh_, wanted, std::vector<char>(facets_.twin.size(), 0));
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    const mirror_symmetry& mirror_;
    std::vector<signed char> of_; // one per triangle
    surface_part part_;
    std::vector<idx> place_; // of each triangle in the half, or -1
};

/// Charts that are mirror images.
struct mirrored_charts
{
    idx pairs = 0, own = 0; ///< own: charts that are their own images
};

inline mirrored_charts count_mirrored(const chart_mesh& charts, const mirror_symmetry& mirror)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<idx> chart(charts.cell_origins.size());
    for (idx k = 0; k < charts.charts(); ++k)
        for (auto i = u(charts.first_cell[u(k)]); i < u(charts.first_cell[u(k) + 1]); ++i)
            chart[u(charts.cell_origins[i])] = k;
    const auto image_of = [&](idx triangle)
    { return chart[u(mirror.triangles.row(mirror.image[u(mirror.polygon[u(triangle)])])[0])]; };
    const auto size = [&](idx k) { return charts.first_cell[u(k) + 1] - charts.first_cell[u(k)]; };
    mirrored_charts found;
    idx halves = 0;
    for (idx k = 0; k < charts.charts(); ++k)
    {
        const auto first = charts.cell_origins.begin() + charts.first_cell[u(k)];
        const idx image = image_of(*first);
        if (size(image) != size(k) || !std::all_of(first, first + size(k), [&](idx c) { return image_of(c) == image; }))
            continue;
        ++(image == k ? found.own : halves);
    }
    found.pairs = halves / 2;
    return found;
}

} // namespace taut::impl
