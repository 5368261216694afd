// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/files/surface/polygons.hpp>

namespace taut::io::impl
{

/// The triangles of a file's faces.
struct face_triangles
{
    std::vector<std::array<idx, 3>> corners; ///< of each triangle: numbers of corners of the faces
    std::size_t polygons = 0;                ///< that were split
    std::size_t fans = 0;                    ///< of these: too large to be split into ears
    std::size_t reversed = 0;                ///< of these: fans from their first corners have reversed triangles
};

/// Splits the polygons among the faces of a file. Two polygons that have three corners in common, as those around a
/// vertex of two faces, would often get one diagonal, or a polygon one that is an edge of another: then an edge has
/// more than two triangles. Diagonals are chosen so that none is there twice, if that can be.
class face_splitting
{
public:
    /// points:  some of them may be non-finite
    /// corners: vertices of all faces, one after the other, some of which may not be there
    face_splitting(std::span<const vec3> points, std::span<const idx> corners, std::span<const idx> sizes)
        : points_(points), corners_(corners), sizes_(sizes)
    {
    }

    face_triangles run()
    {
        first_.push_back(0);
        for (const idx size : sizes_) first_.push_back(first_.back() + size);
        first_triangle_.push_back(0);
        split_.corners.reserve(corners_.size() > 2 * sizes_.size() ? corners_.size() - 2 * sizes_.size() : 0);
        for (std::size_t f = 0; f < sizes_.size(); ++f)
        {
            const auto any = [](std::size_t, std::size_t) { return false; };
            const bool ears = split(f, any, split_.corners);
            split_.polygons += is_polygon(f) ? 1 : 0;
            split_.fans += ears ? 0 : 1;
            split_.reversed += is_polygon(f) && fan_ == ear_clipper::fan::reversed ? 1 : 0;
            first_triangle_.push_back(static_cast<idx>(split_.corners.size()));
        }
        if (split_.polygons > 1 || (split_.polygons > 0 && sizes_.size() > 1)) part_diagonals();
        return std::move(split_);
    }

private:
    using triangles = std::vector<std::array<idx, 3>>;

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    bool is_polygon(std::size_t f) const { return sizes_[f] > 3; }
    std::span<const idx> vertices_of(std::size_t f) const { return corners_.subspan(u(first_[f]), u(sizes_[f])); }
    idx vertex(idx corner) const { return corners_[u(corner)]; }

    /// The first corner of a face whose vertex is not there or has no place; its size if there is none.
    std::size_t unusable_corner(std::size_t f) const
    {
        const auto vertices = vertices_of(f);
        const auto bad = std::find_if(
            vertices.begin(), vertices.end(),
            [this](idx v) { return v < 0 || u(v) >= points_.size() || !taut::impl::finite(points_[u(v)]); });
        return static_cast<std::size_t>(bad - vertices.begin());
    }

    /// Appends the triangles of a face: of a polygon with a corner that cannot be used, a fan around that; of one that
    /// is not convex, a fan from its first corner, as other programs cut it, where that is one. Sets fan_.
    /// Returns false if it is too large for ears.
    template <class NonManifold>
    bool split(std::size_t f, NonManifold non_manifold, triangles& result)
    {
        const std::size_t n = u(sizes_[f]);
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c)
        {
            const idx first = first_[f];
            result.push_back({first + static_cast<idx>(a), first + static_cast<idx>(b), first + static_cast<idx>(c)});
        };
        if (n <= 3) // a line or a point is a triangle that names a vertex twice, as repair knows them
        {
            if (n > 0) add(0, std::min<std::size_t>(n - 1, 1), n - 1);
            return true;
        }
        fan_ = ear_clipper::fan::convex;
        if (const std::size_t bad = unusable_corner(f); bad < n)
        {
            for (std::size_t i = 1; i + 1 < n; ++i) add(bad, (bad + i) % n, (bad + i + 1) % n);
            return true;
        }
        polygon_.clear();
        for (const idx v : vertices_of(f)) polygon_.push_back(points_[u(v)]);
        fan_ = clipper_.fan_of(polygon_);
        if (fan_ == ear_clipper::fan::whole)
        {
            bool taken = false;
            for (std::size_t i = 2; i + 1 < n; ++i) taken = taken || non_manifold(std::size_t(0), i);
            for (std::size_t i = 1; i + 1 < n && !taken; ++i) add(0, i, i + 1);
            if (!taken) return true;
        }
        return clipper_.split(polygon_, vertices_of(f), non_manifold, add);
    }

    /// The triangles that a polygon has now.
    std::span<const std::array<idx, 3>> triangles_of(std::size_t f) const
    {
        if (const auto anew = anew_.find(f); anew != anew_.end()) return anew->second;
        return std::span(split_.corners).subspan(u(first_triangle_[f]), u(first_triangle_[f + 1] - first_triangle_[f]));
    }

    /// Calls diagonal(vertex, vertex) for those of some triangles of a polygon, until it returns true, and returns
    /// that.
    template <class Diagonal>
    bool any_diagonal(std::size_t f, std::span<const std::array<idx, 3>> some, Diagonal&& diagonal) const
    {
        const idx n = sizes_[f];
        for (const auto& t : some)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx a = t[k], b = t[(k + 1) % 3];
                const idx apart = a < b ? b - a : a - b;
                if (apart != 1 && apart != n - 1 && diagonal(vertex(a), vertex(b))) return true;
            }
        return false;
    }

    /// Faces with the same vertices are copies, or the back of each other; they may be split alike.
    static bool same_vertices(std::span<const idx> a, std::span<const idx> b)
    {
        return a.size() == b.size() &&
               std::all_of(a.begin(), a.end(), [b](idx v) { return std::find(b.begin(), b.end(), v) != b.end(); });
    }

    /// Looks for faces beside a polygon, for as long as it takes little time.
    class neighbours
    {
    public:
        neighbours(const face_splitting& faces, std::size_t f)
            : faces_(faces), f_(f), steps_(1024 + 64 * u(faces.sizes_[f]))
        {
        }

        /// Calls other(face, whether it is an edge of that) for the other faces that have an edge, or a diagonal,
        /// between two vertices, until it returns true, and returns that.
        template <class Other>
        bool any(idx v, idx w, Other&& other)
        {
            if (faces_.around_.row(w).size() < faces_.around_.row(v).size()) std::swap(v, w);
            for (const idx corner : faces_.around_.row(v))
            {
                const auto g = u(faces_.face_[u(corner)]);
                const auto own = faces_.vertices_of(f_), vertices = faces_.vertices_of(g);
                if (!spend(vertices.size())) return false;
                if (g == f_) continue;
                if (std::find(vertices.begin(), vertices.end(), w) == vertices.end()) continue;
                if (!spend(own.size() * vertices.size())) return false;
                if (same_vertices(own, vertices)) continue;
                const auto n = faces_.sizes_[g], k = corner - faces_.first_[g];
                const bool edge = vertices[u((k + 1) % n)] == w || vertices[u((k + n - 1) % n)] == w;
                const auto same = [v, w](idx a, idx b) { return (a == v && b == w) || (a == w && b == v); };
                if ((edge || faces_.any_diagonal(g, faces_.triangles_of(g), same)) && other(g, edge)) return true;
            }
            return false;
        }

        bool non_manifold(idx v, idx w)
        {
            return any(v, w, [](std::size_t, bool) { return true; });
        }
        bool on_edge(idx v, idx w)
        {
            return any(v, w, [](std::size_t, bool edge) { return edge; });
        }
        bool non_manifold(std::span<const std::array<idx, 3>> some)
        {
            return faces_.any_diagonal(f_, some, [this](idx v, idx w) { return non_manifold(v, w); });
        }

    private:
        bool spend(std::size_t steps)
        {
            steps_ -= std::min(steps, steps_);
            return steps_ > 0;
        }

        const face_splitting& faces_;
        std::size_t f_, steps_;
    };

    /// Splits polygons anew whose diagonals are taken. One that finds no other way takes a diagonal of another polygon,
    /// which is split anew then.
    void part_diagonals()
    {
        find_faces();
        std::vector<char> bad(sizes_.size(), 0);
        taut::impl::parallel_for(bad.size(),
                                 [&](std::size_t begin, std::size_t end)
                                 {
                                     for (std::size_t f = begin; f < end; ++f)
                                         bad[f] = is_polygon(f) && unusable_corner(f) == u(sizes_[f]) &&
                                                  neighbours(*this, f).non_manifold(triangles_of(f));
                                 });
        std::deque<std::size_t> open;
        for (std::size_t f = 0; f < bad.size(); ++f)
            if (bad[f]) open.push_back(f);
        constexpr int most_turns = 8; // of each polygon
        std::map<std::size_t, int> turns;
        for (; !open.empty(); open.pop_front())
        {
            const std::size_t f = open.front();
            neighbours beside(*this, f);
            if (++turns[f] > most_turns || !beside.non_manifold(triangles_of(f))) continue;
            const auto vertices = vertices_of(f);
            triangles found;
            split(
                f, [&](std::size_t a, std::size_t c) { return beside.non_manifold(vertices[a], vertices[c]); }, found);
            if (beside.non_manifold(found))
            {
                found.clear();
                split(
                    f, [&](std::size_t a, std::size_t c) { return beside.on_edge(vertices[a], vertices[c]); }, found);
                const auto hand_over = [&](std::size_t g, bool)
                {
                    if (is_polygon(g) && unusable_corner(g) == u(sizes_[g])) open.push_back(g);
                    return false;
                };
                any_diagonal(f, found, [&](idx v, idx w) { return beside.any(v, w, hand_over); });
            }
            anew_[f] = std::move(found);
        }
        if (anew_.empty()) return;
        triangles all;
        all.reserve(split_.corners.size());
        for (std::size_t f = 0; f < sizes_.size(); ++f)
        {
            const auto own = triangles_of(f);
            all.insert(all.end(), own.begin(), own.end());
        }
        split_.corners = std::move(all);
    }

    /// Finds the face of each corner, and the corners at each vertex.
    void find_faces()
    {
        face_.resize(corners_.size());
        for (std::size_t f = 0; f < sizes_.size(); ++f)
            std::fill(face_.begin() + first_[f], face_.begin() + first_[f + 1], static_cast<idx>(f));
        around_.items.resize(corners_.size());
        const std::size_t n = points_.size(); // what is not there is one vertex more
        around_.offsets = taut::impl::counting_sort(
            corners_.size(), n + 1, [&](std::size_t c) { return corners_[c] < 0 ? n : std::min(u(corners_[c]), n); },
            [&](std::size_t c, std::size_t at) { around_.items[at] = static_cast<idx>(c); });
    }

    std::span<const vec3> points_;
    std::span<const idx> corners_, sizes_;
    std::vector<idx> first_, first_triangle_; // of each face, and one more
    face_triangles split_;
    std::map<std::size_t, triangles> anew_; // of polygons that were split anew
    std::vector<idx> face_;                 // of each corner
    taut::impl::csr around_;                // corners at each vertex
    ear_clipper clipper_;
    ear_clipper::fan fan_ = ear_clipper::fan::convex; // of the polygon that was split last
    std::vector<vec3> polygon_;
};

} // namespace taut::io::impl
