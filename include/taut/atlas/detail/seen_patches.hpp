// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/exact/crossings.hpp>
#include <taut/exact/predicates.hpp>
#include <taut/mesh/facets.hpp>
#include <taut/mesh/ideal.hpp>

namespace taut::detail
{

/// Disks that a surface is parted into, each as it is seen along the normal of one of its triangles, without flips and
/// overlaps. They cost next to nothing and have a map whatever the surface is.
struct seen_patches
{
    std::vector<idx> patch;              ///< one a triangle, -1 where none was wanted
    std::vector<std::array<vec2, 3>> uv; ///< by corner, in units of the surface
    std::vector<double> energy;          ///< one a patch: area mean of the isometric energy

    static constexpr double most_energy = 6.25; ///< that of a triangle which is seen at 60 degrees
};

/// Grows patches in breadth.
class patch_growing
{
public:
    /// wanted: one flag a triangle; keep: one flag a side, borders that no patch leads over, or empty
    patch_growing(const mesh<triangle>& m, const facet_table& f, std::span<const char> wanted,
                  std::span<const char> keep)
        : mesh_(m), facets_(f), wanted_(wanted), keep_(keep), touched_(m.points().size(), -1), seen_(m.points().size())
    {
        patches_.patch.assign(m.cells().size(), -1);
        patches_.uv.resize(m.cells().size());
    }

    /// largest: triangles of a patch at most
    seen_patches run(std::size_t largest)
    {
        for (std::size_t c = 0; c < wanted_.size(); ++c)
        {
            if (!wanted_[c] || patches_.patch[c] >= 0) continue;
            for (std::size_t most = largest;; most = std::min(most, front_.size()) / 8)
            {
                grow(static_cast<idx>(c), most);
                if (front_.size() == 1 || !overlaps()) break;
                undo();
            }
        }
        return std::move(patches_);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Grows a patch around a triangle.
    void grow(idx seed, std::size_t largest)
    {
        const auto id = static_cast<idx>(patches_.energy.size());
        double area = 0, sum = 0;
        const auto take = [&](idx c, double cosine)
        {
            const double weight = glm::length(doubled_normal(c));
            area += weight;
            sum += weight * (1 + cosine * cosine) * (1 + 1 / (cosine * cosine));
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
        normal_ = glm::normalize(doubled_normal(seed));
        across_ = glm::normalize(x[1] - x[0]);
        up_ = glm::cross(normal_, across_);
        if (!(see(seed) > 0)) // too thin to be seen: it is laid by its lengths, alone
        {
            const mat2 W = stiff_ideal(x[1] - x[0], x[2] - x[0]);
            patches_.uv[u(seed)] = {vec2(0.0), W[0], W[1]};
            largest = 1;
        }
        front_.clear();
        take(seed, 1);
        for (std::size_t i = 0; i < front_.size(); ++i)
            for (idx s = 3 * front_[i]; s < 3 * front_[i] + 3 && front_.size() < largest; ++s)
            {
                if (!leads_on(s)) continue;
                const idx t = facets_.twin[u(s)], c = t / 3;
                if (!wanted_[u(c)] || patches_.patch[u(c)] >= 0 || !stays_disk(t, id)) continue;
                if (const double cosine = see(c); cosine > 0) take(c, cosine);
            }
        patches_.energy.push_back(sum / area);
    }

    /// Whether the border of the last patch, which is a disk, meets itself.
    bool overlaps() const
    {
        const auto id = static_cast<idx>(patches_.energy.size()) - 1;
        std::vector<std::array<idx, 2>> border;
        for (const idx c : front_)
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (!leads_on(s) || patches_.patch[u(facets_.twin[u(s)] / 3)] != id)
                    border.push_back(side_vertices(mesh_, s));
        return !for_each_meeting(border, seen_, [](std::size_t, std::size_t) { return false; });
    }

    /// Forgets the last patch.
    void undo()
    {
        for (const idx c : front_)
        {
            patches_.patch[u(c)] = -1;
            for (const idx v : mesh_.cells()[u(c)]) touched_[u(v)] = -1;
        }
        patches_.energy.pop_back();
    }

    vec3 doubled_normal(idx c) const
    {
        const auto x = mesh_.rest(c);
        return glm::cross(x[1] - x[0], x[2] - x[0]);
    }

    bool leads_on(idx side) const { return facets_.twin[u(side)] >= 0 && (keep_.empty() || !keep_[u(side)]); }

    /// Whether the patch remains a disk with the triangle behind a side: it meets it in that edge and nothing else, or
    /// in edges that meet.
    bool stays_disk(idx side, idx id) const
    {
        const idx c = side / 3;
        if (touched_[u(mesh_.cells()[u(c)][u(side % 3)])] != id) return true;
        for (idx s = 3 * c; s < 3 * c + 3; ++s)
            if (s != side && leads_on(s) && patches_.patch[u(facets_.twin[u(s)] / 3)] == id) return true;
        return false;
    }

    /// Lays a triangle as it is seen. Returns the cosine of its angle to the axis; 0 where it is seen at a slant.
    double see(idx c)
    {
        constexpr double least = 0.5;
        const vec3 n = doubled_normal(c);
        const double cosine = glm::dot(n, normal_) / glm::length(n);
        if (!(cosine > least)) return 0;
        const auto x = mesh_.rest(c);
        std::array<vec2, 3> uv;
        for (std::size_t k = 0; k < 3; ++k) uv[k] = {glm::dot(x[k] - origin_, across_), glm::dot(x[k] - origin_, up_)};
        if (orient2d(uv[0], uv[1], uv[2]) <= 0) return 0;
        patches_.uv[u(c)] = uv;
        return std::min(cosine, 1.0);
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::span<const char> wanted_, keep_;
    std::vector<idx> touched_; // one a vertex: the last patch that has it
    std::vector<vec2> seen_;   // one a vertex: where it was seen last
    std::vector<idx> front_;   // the triangles of the last patch
    vec3 origin_{0.0}, normal_{0.0}, across_{0.0}, up_{0.0};
    seen_patches patches_;
};

} // namespace taut::detail
