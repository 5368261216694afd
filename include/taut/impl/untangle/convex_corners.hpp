// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/counting_sort.hpp>
#include <taut/impl/core/disjoint_sets.hpp>
#include <taut/impl/exact/certify.hpp>
#include <taut/impl/exact/convex_polygons.hpp>
#include <taut/impl/mesh/incidence.hpp>
#include <taut/impl/mesh/mesh.hpp>
#include <taut/impl/untangle/element_newton.hpp>
#include <taut/impl/untangle/epsilon_schedule.hpp>

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
    bool make_convex(map& x)
    {
        constexpr int widest = 32; // rings of faces around a concave corner
        bool changed = false;
        auto wrong = concave(x);
        if (wrong.empty()) return false;
        around_ = vertex_cells(mesh_);
        members_ = cells_by_polygon();
        for (int rings = 1; rings <= widest && !wrong.empty() && proceed_(); rings *= 2)
        {
            for (const auto& patch : patches(wrong, rings)) changed = mend(patch, x) || changed;
            wrong = concave(x);
        }
        return changed;
    }

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
    std::vector<region> patches(const std::vector<idx>& wrong, int rings) const
    {
        std::vector<char> chosen(mesh_.cells().size(), 0), reached(mesh_.points().size(), 0);
        std::vector<idx> front;
        const auto reach = [&](idx v)
        {
            if (!std::exchange(reached[u(v)], 1)) front.push_back(v);
        };
        for (const idx k : wrong)
            for (const idx v : polygons_.corners[u(k)]) reach(v);
        for (int ring = 0; ring < rings; ++ring)
            for (const idx v : std::exchange(front, {}))
                for (const idx near : around_.row(v))
                {
                    if (chosen[u(near)]) continue;
                    for (const idx c : members_.row(polygon_[u(near)]))
                    {
                        chosen[u(c)] = 1;
                        for (const idx w : mesh_.cells()[u(c)]) reach(w);
                    }
                }
        return components(chosen);
    }

    std::vector<region> components(const std::vector<char>& chosen) const
    {
        disjoint_sets sets(mesh_.vertex_count());
        const auto& cells = mesh_.cells();
        for (std::size_t c = 0; c < cells.size(); ++c)
            for (const std::size_t k : {0u, 1u})
                if (chosen[c]) sets.join(cells[c][k], cells[c][k + 1]);
        std::vector<region> all;
        std::vector<idx> place(mesh_.points().size(), -1);
        for (std::size_t c = 0; c < cells.size(); ++c)
        {
            if (!chosen[c]) continue;
            idx& of = place[u(sets.find(cells[c][0]))];
            if (of < 0)
            {
                of = as_idx(all.size());
                all.emplace_back();
            }
            all[u(of)].cells.push_back(as_idx(c));
        }
        for (idx k = 0; k < polygons_.size(); ++k)
        {
            const idx c = members_.row(polygons_.numbers[u(k)]).front();
            if (!chosen[u(c)]) continue;
            for (idx i = polygons_.first[u(k)]; i < polygons_.first[u(k) + 1]; ++i)
                all[u(place[u(sets.find(cells[u(c)][0]))])].corners.push_back(i);
        }
        return all;
    }

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

    piece make_piece(const region& p, const map& x)
    {
        piece part;
        for (const idx c : p.cells)
            for (const idx v : mesh_.cells()[u(c)])
                if (number_[u(v)] < 0)
                {
                    number_[u(v)] = as_idx(part.vertices.size());
                    part.vertices.push_back(v);
                }
        const auto local = [&](cell t)
        {
            for (idx& v : t) v = number_[u(v)];
            return t;
        };
        for (const idx c : p.cells) part.cells.push_back(local(mesh_.cells()[u(c)]));
        part.triangles = part.cells.size();
        for (const idx v : part.vertices) part.x.push_back(x[u(v)]);
        for (std::size_t c = 0; c < part.triangles; ++c)
        {
            part.shapes.push_back(shape_as_mapped(part.cells[c], part.x));
            part.wanted.push_back(shape_in_space(mesh_.cells()[u(p.cells[c])]));
        }
        std::vector<std::uint8_t> bits;
        for (const idx v : part.vertices)
        {
            bits.push_back(held_.empty() ? std::uint8_t(0) : held_[u(v)]);
            for (const idx c : around_.row(v))
                if (!std::binary_search(p.cells.begin(), p.cells.end(), c)) bits.back() = fixed_marks<2>::every;
        }
        part.held = fixed_marks<2>(std::move(bits));
        for (const idx k : p.corners)
        {
            const cell t = local(polygons_.corners[u(k)]);
            if (part.held.all(u(t[0])) && part.held.all(u(t[1])) && part.held.all(u(t[2]))) continue;
            part.cells.push_back(t);
            part.shapes.push_back(shape_of_corner(polygons_.corners[u(k)], t, part.x));
            part.wanted.push_back(shape_in_space(polygons_.corners[u(k)]));
        }
        for (const idx v : part.vertices) number_[u(v)] = -1;
        double mapped = 0, own = 0;
        for (std::size_t c = 0; c < part.triangles; ++c)
        {
            mapped += part.shapes[c].weight;
            own += part.wanted[c].weight;
        }
        for (auto& s : part.wanted) s.inverse *= std::sqrt(own / mapped);
        return part;
    }

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

    bool mend(const region& p, map& x)
    {
        piece part = make_piece(p, x);
        const auto wrong = [&part](const map& y)
        {
            return std::count_if(part.cells.begin() + static_cast<std::ptrdiff_t>(part.triangles), part.cells.end(),
                                 [&](const cell& t) { return !turns_left(t, y); });
        };
        const std::span triangles(part.cells.data(), part.triangles);
        const auto before = wrong(part.x);
        const map best = untangled(part, wrong);
        if (best.empty() || wrong(best) >= before) return false;
        part.x = best;
        const map relaxed_map = relaxed(part);
        for (const map* y : {&relaxed_map, &best})
        {
            if (wrong(*y) >= before || !certify<2>(triangles, std::span<const vec2>(*y))) continue;
            for (std::size_t k = 0; k < part.vertices.size(); ++k) x[u(part.vertices[k])] = (*y)[k];
            return true;
        }
        return false;
    }

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
    map relaxed(const piece& part) const
    {
        constexpr int steps = 30;
        constexpr double gain = 1e-4; // least gain of a step, relative
        std::vector<cell> cells;
        std::vector<target_shape<2>> shapes;
        for (std::size_t c = 0; c < part.cells.size(); ++c)
            if (turns_left(part.cells[c], part.x))
            {
                cells.push_back(part.cells[c]);
                shapes.push_back(part.shapes[c]);
            }
        const mesh<triangle> elements(std::vector<vec3>(part.x.size()), std::move(cells));
        auto newton = newton_on(part, elements, std::move(shapes));
        newton.proceed = proceed_;
        map x = part.x;
        double here = newton.value(x);
        for (int i = 0; i < steps && here < std::numeric_limits<double>::infinity() && proceed_(); ++i)
        {
            const double there = newton.step(x, here);
            const bool ends = !(here - there > gain * here);
            here = there;
            if (ends) break;
        }
        return x;
    }

    const mesh<triangle>& mesh_;
    std::span<const idx> polygon_;
    const convex_polygons& polygons_;
    const fixed_marks<2>& held_;
    std::function<bool()> proceed_;
    std::vector<idx> number_; // of vertices in the piece at hand; -1: not in it
    csr around_, members_;    // triangles of vertices, of polygons
};

} // namespace taut::impl
