// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/symmetry.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/core/mesh/point_grid.hpp>

namespace taut::impl
{

/// Search for a plane of symmetry.
class symmetry_search
{
public:
    /// together: as in segment_params; tolerance: of the diagonal of the box about the vertices
    symmetry_search(const mesh<triangle>& m, const facet_table& f, std::span<const char> together, double tolerance)
        : mesh_(m),
          facets_(f),
          together_(together),
          box_(box_of(m)),
          reach_(tolerance * glm::distance(box_[0], box_[1])),
          grid_(m.points(), reach_),
          polygon_(polygons_of(f, together))
    {
        for (const vec3& x : m.points()) middle_ += x;
        middle_ /= static_cast<double>(m.points().size());
        triangles_.items.resize(polygon_.size());
        triangles_.offsets = counting_sort(
            polygon_.size(), polygon_.size(), [&](std::size_t c) { return polygon_[c]; },
            [&](std::size_t c, std::size_t position) { triangles_.items[position] = static_cast<idx>(c); });
    }

    /// Tries planes across the axes first, then all that map one of a few vertices to another as far from the centre.
    mirror_symmetry run()
    {
        for (const vec3& axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
            for (const vec3& point : {box_[0] / 2.0 + box_[1] / 2.0, middle_, vec3(0.0)})
                if (try_plane(axis, glm::dot(axis, point))) return std::move(*found_);
        for (const idx v : pivots())
        {
            const double far = distance_to_middle(v);
            for (idx w = 0; w < mesh_.vertex_count(); ++w)
            {
                const vec3 across = at(v) - at(w);
                const double length = glm::length(across);
                if (std::abs(distance_to_middle(w) - far) > 8 * reach_ || !(length > 8 * reach_)) continue;
                const vec3 normal = across / length;
                if (try_plane(normal, glm::dot(normal, at(v) / 2.0 + at(w) / 2.0))) return std::move(*found_);
            }
        }
        refuse();
    }

private:
    static constexpr std::size_t samples = 32;
    static constexpr int most_looked_at = 12; // of planes in which all samples have images

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    static std::array<vec3, 2> box_of(const mesh<triangle>& m)
    {
        std::array<vec3, 2> box{m.points()[0], m.points()[0]};
        for (const vec3& x : m.points()) box = {glm::min(box[0], x), glm::max(box[1], x)};
        return box;
    }

    const vec3& at(idx v) const { return mesh_.points()[u(v)]; }
    double distance_to_middle(idx v) const { return glm::distance(at(v), middle_); }

    /// Chooses a few vertices, the farthest first, as few of all lie on the plane.
    std::vector<idx> pivots() const
    {
        constexpr idx count = 4;
        std::vector<idx> result;
        idx farthest = 0;
        for (idx v = 0; v < mesh_.vertex_count(); ++v)
            if (distance_to_middle(v) > distance_to_middle(farthest)) farthest = v;
        result.push_back(farthest);
        for (idx k = 1; k < count; ++k)
            result.push_back(static_cast<idx>(u(mesh_.vertex_count()) * u(2 * k - 1) / u(2 * count)));
        return result;
    }

    /// Returns whether a side is a diagonal of a polygon.
    bool inner(std::size_t side) const { return !together_.empty() && together_[side] != 0 && facets_.twin[side] >= 0; }

    /// Returns whether it is a plane of symmetry, which is then in found_.
    bool try_plane(const vec3& normal, double offset)
    {
        const auto image = [&](std::size_t v)
        {
            const vec3& x = mesh_.points()[v];
            return grid_.nearest(x - 2 * (glm::dot(normal, x) - offset) * normal);
        };
        const std::size_t n = mesh_.points().size(), step = std::max<std::size_t>(1, n / samples);
        std::size_t with = 0, asked = 0;
        for (std::size_t v = 0; v < n; v += step, ++asked) with += image(v) >= 0;
        const double share = static_cast<double>(with) / static_cast<double>(asked);
        if (share <= best_share_ && (share < 1 || looked_at_ >= most_looked_at)) return false;
        ++looked_at_;
        mirror_symmetry plane{normal, offset, std::vector<idx>(n), {}, {}, {}, {}};
        parallel_for(n,
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t v = begin; v < end; ++v) plane.vertex[v] = image(v);
                     });
        std::vector<idx> missing;
        for (std::size_t v = 0; v < n; ++v)
            if (plane.vertex[v] < 0 || plane.vertex[u(plane.vertex[v])] != static_cast<idx>(v))
                missing.push_back(static_cast<idx>(v));
        const bool edges = missing.empty();
        if (edges) missing = match_sides(plane);
        best_share_ = std::max(best_share_, share);
        if (missing.empty())
        {
            found_ = std::move(plane);
            return true;
        }
        if (missing_.empty() || missing.size() < missing_.size())
        {
            missing_ = std::move(missing);
            edges_ = edges;
            normal_ = normal;
            offset_ = offset;
        }
        return false;
    }

    /// Finds the images of all sides and polygons. Returns vertices at sides that have none, or whose polygon has none.
    std::vector<idx> match_sides(mirror_symmetry& plane) const
    {
        const std::size_t sides = facets_.twin.size();
        std::vector<idx> by_start(sides);
        const auto start = counting_sort(
            sides, mesh_.points().size(), [&](std::size_t s) { return side_vertices(mesh_, static_cast<idx>(s))[0]; },
            [&](std::size_t s, std::size_t position) { by_start[position] = static_cast<idx>(s); });
        plane.side.assign(sides, -1);
        plane.image.assign(u(triangles_.rows()), -1);
        std::vector<idx> missing, count(plane.image.size(), 0); // of sides around each polygon
        for (std::size_t s = 0; s < sides; ++s)
        {
            if (inner(s)) continue;
            const auto [a, b] = side_vertices(mesh_, static_cast<idx>(s));
            const auto first = by_start.begin() + start[u(plane.vertex[u(b)])];
            const auto last = by_start.begin() + start[u(plane.vertex[u(b)]) + 1];
            const auto side = std::find_if(first, last,
                                           [&, end = plane.vertex[u(a)]](idx t)
                                           { return !inner(u(t)) && side_vertices(mesh_, t)[1] == end; });
            idx& image = plane.image[u(polygon_[s / 3])];
            const idx there = side == last ? -1 : polygon_[u(*side) / 3];
            if (there < 0 || (image >= 0 && image != there)) missing.insert(missing.end(), {a, b});
            if (there < 0) continue;
            plane.side[s] = *side;
            image = there;
            ++count[u(polygon_[s / 3])];
        }
        for (std::size_t s = 0; missing.empty() && s < sides; ++s)
            if (const idx p = polygon_[s / 3]; count[u(p)] != count[u(plane.image[u(p)])])
                missing.push_back(mesh_.cells()[s / 3][s % 3]);
        std::sort(missing.begin(), missing.end());
        missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
        plane.polygon = polygon_;
        plane.triangles = triangles_;
        return missing;
    }

    [[noreturn]] void refuse() { throw symmetry_error(normal_, offset_, std::move(missing_), edges_); }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::span<const char> together_;
    std::array<vec3, 2> box_;
    vec3 middle_{0.0};
    double reach_;
    point_grid grid_;
    std::vector<idx> polygon_; // one per triangle
    csr triangles_;            // of each polygon
    std::optional<mirror_symmetry> found_;
    double best_share_ = -1;   // of the samples that had images
    int looked_at_ = 0;        // planes, as a whole
    std::vector<idx> missing_; // in the best plane
    bool edges_ = false;
    vec3 normal_{0.0};
    double offset_ = 0;
};

} // namespace taut::impl

namespace taut
{

std::string symmetry_error::message(const vec3& normal, double offset, const std::vector<idx>& vertices, bool edges)
{
    const auto text = [](double x)
    {
        std::string digits = std::to_string(x);
        digits.erase(std::max(digits.find_last_not_of('0'), digits.find('.') + 1) + 1);
        return digits;
    };
    return "the surface has no plane of symmetry: in the best one, of normal (" + text(normal.x) + ", " +
           text(normal.y) + ", " + text(normal.z) + ") at " + text(offset) + ", " +
           impl::list_ids("vertex", "vertices", vertices) + (vertices.size() == 1 ? " has" : " have") +
           (edges ? " edges without a mirror image" : " no mirror image") + "; move them, or leave symmetry out";
}

mirror_symmetry impl::find_symmetry(const mesh<triangle>& m, const facet_table& f, std::span<const char> together,
                                    double tolerance)
{
    return symmetry_search(m, f, together, tolerance).run();
}

} // namespace taut
