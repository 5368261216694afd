// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// A sum of squared distances from planes, as a function of the point (Garland, Heckbert 1997, "Surface simplification
/// using quadric error metrics").
struct quadric
{
    std::array<double, 6> second{}; ///< xx, xy, xz, yy, yz, zz
    vec3 first{0.0};
    double constant = 0;

    /// Adds the plane dot(n, x) + d = 0, n a unit vector.
    void add(const vec3& n, double d, double weight)
    {
        std::size_t i = 0;
        for (int r = 0; r < 3; ++r)
            for (int c = r; c < 3; ++c) second[i++] += weight * n[r] * n[c];
        first += weight * d * n;
        constant += weight * d * d;
    }

    quadric& operator+=(const quadric& other)
    {
        for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
        first += other.first;
        constant += other.constant;
        return *this;
    }

    double operator()(const vec3& x) const
    {
        const auto& q = second;
        return q[0] * x.x * x.x + q[3] * x.y * x.y + q[5] * x.z * x.z +
               2 * (q[1] * x.x * x.y + q[2] * x.x * x.z + q[4] * x.y * x.z + glm::dot(first, x)) + constant;
    }
};

/// A surface of fewer triangles whose vertices are vertices of another one.
struct coarse_surface
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> origins; ///< the vertex of the other surface, one a vertex
};

/// Takes vertices away, those first that leave most of the shape: half-edge collapses by quadrics (Garland, Heckbert
/// 1997). The surface stays a manifold of the same topology, its boundary loops stay loops.
class decimating
{
public:
    decimating(const mesh<triangle>& m, const facet_table& f)
        : mesh_(m),
          cells_(m.cells()),
          head_(m.points().size(), -1),
          tail_(m.points().size(), -1),
          next_(3 * m.cells().size(), -1),
          alive_(m.cells().size(), 1),
          rim_(m.points().size(), 0),
          quadrics_(m.points().size()),
          stamp_(m.points().size(), 0),
          left_(m.cell_count())
    {
        origin_ = m.points().front(); // quadrics of far points would cancel
        for (idx c = 0; c < m.cell_count(); ++c)
            for (idx k = 0; k < 3; ++k) append(cells_[u(c)][u(k)], 3 * c + k);
        for (idx c = 0; c < m.cell_count(); ++c) add_planes(f, c);
    }

    /// Goes on until there are `target` triangles, or nothing can be taken away any more.
    /// least_cosine: cosine between normals of a triangle before and after, at least
    /// proceed: asked now and then: go on?
    void run(idx target, double least_cosine, const std::function<bool()>& proceed)
    {
        least_cosine_ = least_cosine;
        scale_ = 2 * area_ / target;
        std::vector<candidate> first(head_.size());
        parallel_for(
            first.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t v = begin; v < end; ++v) first[v] = best(static_cast<idx>(v));
            },
            0, 256);
        std::priority_queue<candidate, std::vector<candidate>, std::greater<>> queue;
        for (const candidate& c : first)
            if (c.to >= 0) queue.push(c);
        std::vector<idx> ring;
        for (std::size_t turn = 1; left_ > target && !queue.empty(); ++turn)
        {
            constexpr std::size_t often = 4096;
            if (turn % often == 0 && proceed && !proceed()) return;
            const candidate c = queue.top();
            queue.pop();
            if (head_[u(c.from)] < 0) continue;
            if (c.stamp != stamp_[u(c.from)])
            {
                if (const candidate now = best(c.from); now.to >= 0) queue.push(now);
                continue;
            }
            collapse(c.from, c.to);
            around(c.to, ring);
            for (const idx v : ring) ++stamp_[u(v)];
            ++stamp_[u(c.to)];
        }
    }

    idx triangles() const { return left_; }

    coarse_surface result() const
    {
        coarse_surface r;
        std::vector<idx> number(head_.size(), -1);
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            if (!alive_[c]) continue;
            auto t = cells_[c];
            for (idx& v : t)
            {
                idx& n = number[u(v)];
                if (n < 0)
                {
                    n = static_cast<idx>(r.points.size());
                    r.points.push_back(mesh_.points()[u(v)]);
                    r.origins.push_back(v);
                }
                v = n;
            }
            r.cells.push_back(t);
        }
        return r;
    }

private:
    struct candidate
    {
        double cost = 0;
        idx from = -1, to = -1;
        std::uint32_t stamp = 0;

        bool operator>(const candidate& o) const { return cost != o.cost ? cost > o.cost : from > o.from; }
    };

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    const vec3& point(idx v) const { return mesh_.points()[u(v)]; }

    void append(idx v, idx corner)
    {
        (tail_[u(v)] < 0 ? head_[u(v)] : next_[u(tail_[u(v)])]) = corner;
        tail_[u(v)] = corner;
    }

    void add_planes(const facet_table& f, idx c)
    {
        const auto x = mesh_.rest(c);
        const vec3 normal = glm::cross(x[1] - x[0], x[2] - x[0]);
        const double twice = glm::length(normal);
        area_ += twice / 2;
        if (twice > 0)
            for (const idx v : cells_[u(c)])
                quadrics_[u(v)].add(normal / twice, -glm::dot(normal / twice, x[0] - origin_), twice);
        for (idx k = 0; k < 3; ++k)
        {
            if (f.twin[u(3 * c + k)] >= 0) continue;
            const vec3 &a = x[u((k + 1) % 3)], &b = x[u((k + 2) % 3)];
            const vec3 across = glm::cross(b - a, normal);
            const double size = glm::length(across);
            for (const idx j : {k + 1, k + 2})
            {
                const idx v = cells_[u(c)][u(j % 3)];
                rim_[u(v)] = 1;
                constexpr double stiff = 10; // boundaries keep their shape more than the inside
                if (size > 0)
                    quadrics_[u(v)].add(across / size, -glm::dot(across / size, a - origin_),
                                        stiff * glm::dot(b - a, b - a));
            }
        }
    }

    /// Calls f(corner) for the corners of a vertex.
    template <class F>
    void for_each_corner(idx v, F&& f) const
    {
        for (idx c = head_[u(v)]; c >= 0; c = next_[u(c)])
            if (alive_[u(c / 3)]) f(c);
    }

    /// Its neighbours, each once.
    void around(idx v, std::vector<idx>& ring) const
    {
        ring.clear();
        for_each_corner(v,
                        [&](idx corner)
                        {
                            const auto& t = cells_[u(corner / 3)];
                            ring.push_back(t[u((corner + 1) % 3)]);
                            ring.push_back(t[u((corner + 2) % 3)]);
                        });
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    }

    /// The cheapest collapse of a vertex that may be made.
    candidate best(idx v) const
    {
        static thread_local std::vector<idx> ring, other;
        static thread_local std::vector<std::pair<double, idx>> order;
        candidate result{.cost = 0, .from = v, .to = -1, .stamp = stamp_[u(v)]};
        if (head_[u(v)] < 0) return result;
        around(v, ring);
        order.clear();
        for (const idx w : ring)
        {
            if (rim_[u(v)] && !rim_[u(w)]) continue;
            const vec3 x = point(w) - origin_, d = point(w) - point(v);
            order.emplace_back(quadrics_[u(v)](x) + quadrics_[u(w)](x) + 1e-4 * scale_ * glm::dot(d, d), w);
        }
        std::sort(order.begin(), order.end());
        constexpr std::size_t most = 6; // tried
        for (std::size_t i = 0; i < std::min(most, order.size()); ++i)
        {
            const double shape = shape_after(v, order[i].second, ring, other);
            if (shape <= 0) continue;
            result.cost = std::max(order[i].first, 0.0) * (1 + 0.1 / shape);
            result.to = order[i].second;
            break;
        }
        return result;
    }

    /// The least quality of the triangles of v once it is collapsed to w; 0 if it must not be.
    double shape_after(idx v, idx w, const std::vector<idx>& ring, std::vector<idx>& other) const
    {
        idx shared = 0;
        for_each_corner(v,
                        [&](idx corner)
                        {
                            const auto& t = cells_[u(corner / 3)];
                            shared += t[0] == w || t[1] == w || t[2] == w;
                        });
        if (shared != (rim_[u(v)] ? 1 : 2)) return 0;
        around(w, other);
        constexpr std::size_t most_neighbours = 18; // of both
        if (ring.size() < (rim_[u(v)] ? 2U : 3U) || ring.size() + other.size() > most_neighbours) return 0;
        if (ring.size() <= 3 && other.size() <= 3) return 0; // a tetrahedron, or two triangles
        idx common = 0;
        for (std::size_t i = 0, j = 0; i < ring.size() && j < other.size();)
        {
            common += ring[i] == other[j];
            ring[i] < other[j] ? ++i : (other[j] < ring[i] ? ++j : (++i, ++j));
        }
        if (common != shared) return 0;
        double least = 1;
        for_each_corner(v,
                        [&](idx corner)
                        {
                            const auto& t = cells_[u(corner / 3)];
                            if (t[0] == w || t[1] == w || t[2] == w || least <= 0) return;
                            const vec3 &a = point(t[u((corner + 1) % 3)]), &b = point(t[u((corner + 2) % 3)]);
                            const vec3 before = glm::cross(a - point(v), b - point(v));
                            const vec3 after = glm::cross(a - point(w), b - point(w));
                            const double size = glm::length(after);
                            const double edges = glm::dot(b - a, b - a) + glm::dot(a - point(w), a - point(w)) +
                                                 glm::dot(b - point(w), b - point(w));
                            const bool turns = glm::dot(before, after) <= least_cosine_ * glm::length(before) * size;
                            least = turns ? 0 : std::min(least, 2 * std::sqrt(3.0) * size / edges);
                        });
        constexpr double slim = 0.05;
        return least < slim ? 0 : least;
    }

    void collapse(idx v, idx w)
    {
        for (idx c = head_[u(v)], after = 0; c >= 0; c = after)
        {
            after = next_[u(c)];
            auto& t = cells_[u(c / 3)];
            next_[u(c)] = -1;
            if (!alive_[u(c / 3)]) continue;
            if (t[0] == w || t[1] == w || t[2] == w)
            {
                alive_[u(c / 3)] = 0;
                --left_;
                continue;
            }
            t[u(c % 3)] = w;
            append(w, c);
        }
        head_[u(v)] = -1;
        quadrics_[u(w)] += quadrics_[u(v)];
    }

    const mesh<triangle>& mesh_;
    std::vector<std::array<idx, 3>> cells_;
    std::vector<idx> head_, tail_, next_; // corners of each vertex, as lists; dead ones among them
    std::vector<char> alive_;             // one a triangle
    std::vector<char> rim_;               // one a vertex
    std::vector<quadric> quadrics_;
    std::vector<std::uint32_t> stamp_; // one a vertex: changes with its neighbours
    idx left_;
    vec3 origin_{0.0};
    double area_ = 0, scale_ = 0, least_cosine_ = 0;
};

/// A surface of about `target` triangles for what is large; the surface itself if it has no more.
/// m: an oriented manifold; f: its facets; proceed: asked now and then, if given, whether to go on; else the surface
/// has more triangles. Deterministic. O(n log n).
inline coarse_surface make_coarse(const mesh<triangle>& m, const facet_table& f, idx target,
                                  const std::function<bool()>& proceed = {})
{
    if (m.cell_count() <= target)
    {
        coarse_surface same{m.points(), m.cells(), std::vector<idx>(m.points().size())};
        std::iota(same.origins.begin(), same.origins.end(), idx(0));
        return same;
    }
    decimating one(m, f);
    one.run(target, 0.1, proceed);
    // Where noise is as large as triangles, normals say nothing.
    if (one.triangles() > target + target / 4 && (!proceed || proceed())) one.run(target, -2.0, proceed);
    return one.result();
}

/// Of the seams that open the handles of a connected surface, the length at least: one edge for each of the loops, two
/// a handle.
inline double least_loops(const mesh<triangle>& m, const facet_table& f)
{
    std::vector<double> edges;
    std::ptrdiff_t border = 0;
    for (std::size_t s = 0; s < f.twin.size(); ++s)
    {
        border += f.twin[s] < 0;
        if (f.twin[s] >= static_cast<idx>(s)) continue;
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        edges.push_back(
            glm::distance(m.points()[static_cast<std::size_t>(a)], m.points()[static_cast<std::size_t>(b)]));
    }
    // By Euler, V - E + F = 2 - 2 handles - borders.
    const auto borders = border > 0 ? boundary_loops(m, f).size() : 0;
    const auto loops = 2 + static_cast<std::ptrdiff_t>(edges.size()) - m.vertex_count() - m.cell_count() -
                       static_cast<std::ptrdiff_t>(borders);
    const auto last = edges.begin() + std::clamp<std::ptrdiff_t>(loops, 0, std::ssize(edges));
    if (last != edges.end()) std::nth_element(edges.begin(), last, edges.end());
    return std::accumulate(edges.begin(), last, 0.0);
}

/// Spans small holes by cones, so that seams and maps are as if there were none. The apices come after all vertices
/// and have no origin. Returns the number of the first triangle of a cone.
inline idx span_small_holes(coarse_surface& s)
{
    constexpr double small = 0.35; // perimeter by the root of the area; that of a disk is 3.5
    const mesh<triangle> m(s.points, s.cells);
    const auto first = static_cast<idx>(s.cells.size());
    const double area = area_of(m, 0, first);
    for (const auto& loop : boundary_loops(m, facets(m)))
    {
        const auto point = [&](std::size_t k) { return s.points[static_cast<std::size_t>(loop[k % loop.size()])]; };
        double perimeter = 0;
        vec3 centre(0.0);
        for (std::size_t k = 0; k < loop.size(); ++k)
        {
            perimeter += glm::distance(point(k), point(k + 1));
            centre += point(k) / static_cast<double>(loop.size());
        }
        if (!(perimeter * perimeter < small * small * area)) continue;
        const auto apex = static_cast<idx>(s.points.size());
        s.points.push_back(centre);
        for (std::size_t k = 0; k < loop.size(); ++k) s.cells.push_back({loop[(k + 1) % loop.size()], loop[k], apex});
    }
    return first;
}

} // namespace taut::impl
