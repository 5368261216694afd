// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include <taut/impl/core/untangle/convex_corners.hpp>

namespace taut::impl
{

bool convex_corners::make_convex(map& x)
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

std::vector<convex_corners::region> convex_corners::patches(const std::vector<idx>& wrong, int rings) const
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

std::vector<convex_corners::region> convex_corners::components(const std::vector<char>& chosen) const
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

convex_corners::piece convex_corners::make_piece(const region& p, const map& x)
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

bool convex_corners::mend(const region& p, map& x)
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

convex_corners::map convex_corners::relaxed(const piece& part) const
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

} // namespace taut::impl
