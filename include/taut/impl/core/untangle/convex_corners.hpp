// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/untangle/element_newton.hpp>
#include <taut/impl/core/untangle/epsilon_schedule.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Makes polygons convex in an injective map: the triangles at their corners, between the corners before and after, are
/// elements as those of the mesh, with little weight. Around concave corners, in patches with a fixed rim, Newton's
/// method on the regularised energy makes all elements positive (Garanzha et al. 2021, "Foldover-free maps in 50 lines
/// of code"), and on the barrier energy lowers the distortion from the map as it was while all of them stay positive.
/// Patches grow where that fails.
class convex_corners
{
public:
    using map = std::vector<vec2>;

    /// polygon: number of the polygon of each triangle; polygons: to be convex, as find_convex_polygons has them; held:
    /// coordinates that are not moved, or empty. All are referred to. proceed: asked before every step
    convex_corners(const mesh<triangle>& m, std::span<const idx> polygon, const convex_polygons& polygons,
                   const fixed_marks<2>& held, std::function<bool()> proceed)
        : mesh_(m),
          polygon_(polygon),
          polygons_(polygons),
          held_(held),
          proceed_(std::move(proceed)),
          number_(m.points().size(), -1)
    {
    }

    /// Returns whether x has changed. Triangles remain positive, and the map injective where it was.
    bool make_convex(map& x);

    /// Corners that do not turn left, but those of vertices that are all held; exact.
    std::vector<idx> concave(const map& x) const
    {
        std::vector<idx> found;
        for (std::size_t k = 0; k < polygons_.corners.size(); ++k)
            if (const auto& t = polygons_.corners[k]; !turns_left(t, x) && !is_held(t)) found.push_back(as_idx(k));
        return found;
    }

private:
    using cell = std::array<idx, 3>;

    struct region
    {
        std::vector<idx> cells;   // ascending
        std::vector<idx> corners; // of polygons
    };

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static idx as_idx(std::size_t i) { return static_cast<idx>(i); }
    static bool turns_left(const cell& t, std::span<const vec2> x)
    {
        return orient2d(x[u(t[0])], x[u(t[1])], x[u(t[2])]) > 0;
    }
    bool is_held(const cell& t) const
    {
        return !held_.empty() && held_.all(u(t[0])) && held_.all(u(t[1])) && held_.all(u(t[2]));
    }

    csr cells_by_polygon() const
    {
        csr rows{{}, std::vector<idx>(polygon_.size())};
        const idx labels = *std::max_element(polygon_.begin(), polygon_.end()) + 1;
        rows.offsets = counting_sort(
            polygon_.size(), u(labels), [&](std::size_t c) { return polygon_[c]; },
            [&](std::size_t c, std::size_t at) { rows.items[at] = as_idx(c); });
        return rows;
    }

    /// Faces within some rings of these corners, by connected components.
    std::vector<region> patches(const std::vector<idx>& wrong, int rings) const;

    std::vector<region> components(const std::vector<char>& chosen) const;

    /// A patch in numbers of its own.
    struct piece
    {
        std::vector<idx> vertices; // of the mesh
        std::vector<cell> cells;   // triangles, then corners
        std::size_t triangles = 0;
        fixed_marks<2> held;
        map x;
        std::vector<target_shape<2>> shapes; // of the cells, as they are mapped
        std::vector<target_shape<2>> wanted; // of the cells, as they are in space, with their total area
    };

    piece make_piece(const region& p, const map& x);

    static target_shape<2> shape_as_mapped(const cell& t, const map& x)
    {
        const vec2 a = x[u(t[1])] - x[u(t[0])], b = x[u(t[2])] - x[u(t[0])];
        const mat2 W = stiff_ideal(vec3(a, 0.0), vec3(b, 0.0));
        return {invert_upper(W), 0.5 * W[0][0] * W[1][1]};
    }

    target_shape<2> shape_in_space(const cell& t) const
    {
        const auto& x = mesh_.points();
        const mat2 W = stiff_ideal(x[u(t[1])] - x[u(t[0])], x[u(t[2])] - x[u(t[0])]);
        return {invert_upper(W), 0.5 * W[0][0] * W[1][1]};
    }

    /// With the angle in space between sides as long as in the map. t: the corner in the piece
    target_shape<2> shape_of_corner(const cell& corner, const cell& t, const map& x) const
    {
        constexpr double least = 0.1, light = 0.02; // of the angle, in radians; weight by the area
        const vec3 in = mesh_.points()[u(corner[1])] - mesh_.points()[u(corner[0])],
                   out = mesh_.points()[u(corner[2])] - mesh_.points()[u(corner[1])];
        const double turn =
            std::clamp(std::atan2(glm::length(glm::cross(in, out)), glm::dot(in, out)), least, 3.141592 - least);
        const vec2 first(glm::distance(x[u(t[0])], x[u(t[1])]), 0.0);
        const vec2 last = glm::distance(x[u(t[1])], x[u(t[2])]) * vec2(std::cos(turn), std::sin(turn));
        const mat2 W = stiff_ideal(vec3(first, 0.0), vec3(first + last, 0.0));
        return {invert_upper(W), light * 0.5 * W[0][0] * W[1][1]};
    }

    /// Newton's method on some of the elements.
    static triangle_newton newton_on(const piece& part, const mesh<triangle>& elements,
                                     std::vector<target_shape<2>> shapes)
    {
        double total = 0;
        for (const auto& s : shapes) total += s.weight;
        for (auto& s : shapes) s.weight /= total;
        return triangle_newton({.rest = elements, .held = part.held, .shapes = std::move(shapes)});
    }

    bool mend(const region& p, map& x);

    /// The map with the fewest concave corners of those without flipped triangles that were seen; empty if none has
    /// fewer.
    template <class Wrong>
    map untangled(const piece& part, const Wrong& wrong) const
    {
        constexpr int steps = 60;
        const mesh<triangle> elements(std::vector<vec3>(part.x.size()), part.cells);
        auto newton = newton_on(part, elements, part.wanted);
        newton.proceed = proceed_;
        map x = part.x, best;
        auto fewest = wrong(x);
        epsilon_schedule schedule(newton.least_det(x));
        for (int i = 0; i < steps && fewest > 0 && proceed_(); ++i)
        {
            newton.eps = schedule.eps();
            const double here = newton.value(x), there = newton.step(x, here);
            if (!std::isfinite(there)) break;
            schedule.lower(here, there, newton.last_length(), newton.least_det(x));
            const auto now = wrong(x);
            const auto end = part.cells.begin() + static_cast<std::ptrdiff_t>(part.triangles);
            if (now >= fewest ||
                !std::all_of(part.cells.begin(), end, [&x](const cell& t) { return turns_left(t, x); }))
                continue;
            fewest = now;
            best = x;
        }
        return best;
    }

    /// Lowers the energy while all elements that are positive stay so.
    map relaxed(const piece& part) const;

    const mesh<triangle>& mesh_;
    std::span<const idx> polygon_;
    const convex_polygons& polygons_;
    const fixed_marks<2>& held_;
    std::function<bool()> proceed_;
    std::vector<idx> number_; // of vertices in the piece at hand; -1: not in it
    csr around_, members_;    // triangles of vertices, of polygons
};

} // namespace taut::impl
