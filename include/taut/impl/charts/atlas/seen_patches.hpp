// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

namespace taut::impl
{

/// Planar-projection charts: disks that a surface is divided into, each projected along the normal of one of its
/// triangles, without flips and overlaps. They are cheap and exist for any surface.
struct seen_patches
{
    std::vector<idx> patch;              ///< one per triangle, -1 where none was wanted
    std::vector<std::array<vec2, 3>> uv; ///< by corner, in units of the surface
    std::vector<double> energy; ///< one per patch: area mean of the isometric energy, below 6.25, that of 60 degrees
};

/// Grows patches breadth-first, in one region of a surface.
class patch_growing
{
public:
    /// patches: those of all regions; it reads and writes the entries of its own triangles, which are numbered from 0
    patch_growing(const mesh<triangle>& m, const facet_table& f, std::span<const char> regions, char own,
                  std::span<const char> keep, seen_patches& patches)
        : mesh_(m),
          facets_(f),
          regions_(regions),
          own_(own),
          keep_(keep),
          touched_(m.points().size(), -1),
          seen_(m.points().size()),
          patches_(patches)
    {
    }

    /// Returns the energies of the patches.
    std::vector<double> run(std::size_t largest)
    {
        for (std::size_t c = 0; c < regions_.size(); ++c)
        {
            if (regions_[c] != own_ || patches_.patch[c] >= 0) continue;
            for (std::size_t most = largest;; most = std::min(most, front_.size()) / 8)
            {
                grow(static_cast<idx>(c), most);
                if (front_.size() <= 2 || !overlaps()) break; // two lie on either side of their edge
                undo();
            }
        }
        return std::move(energy_);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Grows a patch around a triangle.
    void grow(idx seed, std::size_t largest)
    {
        const auto id = static_cast<idx>(energy_.size());
        double area = 0, sum = 0;
        const auto take = [&](idx c, const sight& s)
        {
            area += s.area;
            sum += s.area * (1 + s.cosine * s.cosine) * (1 + 1 / (s.cosine * s.cosine));
            patches_.patch[u(c)] = id;
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto v = u(mesh_.cells()[u(c)][k]);
                touched_[v] = id;
                seen_[v] = patches_.uv[u(c)][k];
            }
            front_.push_back(c);
        };
        const auto x = mesh_.rest(seed);
        origin_ = x[0];
        normal_ = glm::normalize(glm::cross(x[1] - x[0], x[2] - x[0]));
        across_ = glm::normalize(x[1] - x[0]);
        up_ = glm::cross(normal_, across_);
        auto first = see(seed);
        if (!(first.cosine > 0)) // too thin to be seen: it is laid by its lengths, alone
        {
            const mat2 W = stiff_ideal(x[1] - x[0], x[2] - x[0]);
            patches_.uv[u(seed)] = {vec2(0.0), W[0], W[1]};
            largest = 1;
        }
        first.cosine = 1;
        front_.clear();
        take(seed, first);
        for (std::size_t i = 0; i < front_.size(); ++i)
            for (idx s = 3 * front_[i]; s < 3 * front_[i] + 3 && front_.size() < largest; ++s)
            {
                if (!leads_on(s)) continue;
                const idx t = facets_.twin[u(s)], c = t / 3;
                if (patches_.patch[u(c)] >= 0 || !stays_disk(t, id)) continue;
                if (const sight seen = see(c); seen.cosine > 0) take(c, seen);
            }
        energy_.push_back(sum / area);
    }

    /// Returns whether the border of the last patch, which is a disk, meets itself.
    bool overlaps()
    {
        const auto id = static_cast<idx>(energy_.size()) - 1;
        border_.clear();
        for (const idx c : front_)
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (!leads_on(s) || patches_.patch[u(facets_.twin[u(s)] / 3)] != id)
                    border_.push_back(side_vertices(mesh_, s));
        return !for_each_meeting(border_, seen_, [](std::size_t, std::size_t) { return false; });
    }

    /// Discards the last patch.
    void undo()
    {
        for (const idx c : front_)
        {
            patches_.patch[u(c)] = -1;
            for (const idx v : mesh_.cells()[u(c)]) touched_[u(v)] = -1;
        }
        energy_.pop_back();
    }

    bool leads_on(idx side) const
    {
        const idx t = facets_.twin[u(side)];
        return t >= 0 && regions_[u(t) / 3] == own_ && (keep_.empty() || !keep_[u(side)]);
    }

    /// Returns whether the patch remains a disk with the triangle behind a side: it meets it in that edge and nothing
    /// else, or in edges that meet.
    bool stays_disk(idx side, idx id) const
    {
        const idx c = side / 3;
        if (touched_[u(mesh_.cells()[u(c)][u(side % 3)])] != id) return true;
        for (idx s = 3 * c; s < 3 * c + 3; ++s)
            if (s != side && leads_on(s) && patches_.patch[u(facets_.twin[u(s)] / 3)] == id) return true;
        return false;
    }

    /// View of a triangle from the axis: twice its area, and the cosine of its angle to the axis; 0 at a slant.
    struct sight
    {
        double area, cosine;
    };

    /// Projects a triangle.
    sight see(idx c)
    {
        constexpr double least = 0.5;
        const auto x = mesh_.rest(c);
        const vec3 n = glm::cross(x[1] - x[0], x[2] - x[0]);
        const double area = glm::length(n), cosine = glm::dot(n, normal_) / area;
        if (!(cosine > least)) return {area, 0};
        std::array<vec2, 3> uv;
        for (std::size_t k = 0; k < 3; ++k) uv[k] = {glm::dot(x[k] - origin_, across_), glm::dot(x[k] - origin_, up_)};
        if (orient2d(uv[0], uv[1], uv[2]) <= 0) return {area, 0};
        patches_.uv[u(c)] = uv;
        return {area, std::min(cosine, 1.0)};
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::span<const char> regions_;
    char own_;
    std::span<const char> keep_;
    std::vector<idx> touched_;               // one per vertex: the last patch that has it
    std::vector<vec2> seen_;                 // one per vertex: where it was seen last
    std::vector<idx> front_;                 // the triangles of the last patch
    std::vector<std::array<idx, 2>> border_; // its border
    vec3 origin_{0.0}, normal_{0.0}, across_{0.0}, up_{0.0};
    seen_patches& patches_;
    std::vector<double> energy_; // one per patch
};

/// regions: one per triangle, from 1; 0: no patch there. Patches stay within a region, so that regions are processed in
/// parallel. keep: one flag per side, borders that no patch crosses, or empty; largest: maximum number of triangles of
/// a patch
inline seen_patches lay_as_seen(const mesh<triangle>& m, const facet_table& f, std::span<const char> regions,
                                std::span<const char> keep, std::size_t largest)
{
    seen_patches patches{
        std::vector<idx>(m.cells().size(), -1), std::vector<std::array<vec2, 3>>(m.cells().size()), {}};
    const char last = *std::max_element(regions.begin(), regions.end());
    std::vector<std::vector<double>> energy(static_cast<std::size_t>(last));
    parallel_for(
        energy.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t r = begin; r < end; ++r)
                energy[r] = patch_growing(m, f, regions, static_cast<char>(r + 1), keep, patches).run(largest);
        },
        0, 1);
    std::vector<idx> first{0}; // patch of each region; of what is in none, whatever
    for (const auto& some : energy)
    {
        first.push_back(static_cast<idx>(patches.energy.size()));
        patches.energy.insert(patches.energy.end(), some.begin(), some.end());
    }
    for (std::size_t c = 0; c < regions.size(); ++c) patches.patch[c] += first[static_cast<std::size_t>(regions[c])];
    return patches;
}

/// Octant of each triangle about the mean of the vertices: 1 to 8.
inline std::vector<char> octants(const mesh<triangle>& m)
{
    vec3 sum(0.0);
    for (const vec3& x : m.points()) sum += x;
    const vec3 middle = sum / static_cast<double>(m.points().size());
    std::vector<char> octant(m.cells().size());
    parallel_for(octant.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         const auto x = m.rest(static_cast<idx>(c));
                         const auto above = glm::greaterThan((x[0] + x[1] + x[2]) / 3.0, middle);
                         octant[c] = static_cast<char>(1 + above.x + 2 * above.y + 4 * above.z);
                     }
                 });
    return octant;
}

} // namespace taut::impl
