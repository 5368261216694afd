// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/rigid_motion.hpp>

namespace taut::impl
{

/// Paths of fixed vertices to their targets: bodies, connected by edges between pinned vertices, move rigidly, and the
/// remaining displacement is linear. On straight lines alone a face that rotates by half a turn would shrink to a point
/// half way.
template <int D>
class prescribed_paths
{
public:
    using map = std::vector<vec<D>>;

    /// cells: their D + 1 vertices. from, to: one position per vertex, of `to` only fixed coordinates are read. Refers
    /// to them and to the marks.
    prescribed_paths(std::span<const std::array<idx, D + 1>> cells, const fixed_marks<D>& marks, const map& from,
                     const map& to)
        : marks_(marks), from_(from), to_(to), body_(marks.size(), -1)
    {
        for (const auto& body : bodies(cells))
        {
            map points, images;
            for (const std::size_t v : body)
            {
                points.push_back(from[v]);
                images.push_back(to[v]);
                body_[v] = static_cast<idx>(motions_.size());
            }
            sizes_.push_back(body.size());
            motions_.push_back(fit_rigid_motion(std::span<const vec<D>>(points), std::span<const vec<D>>(images)));
        }
    }

    /// Number of parts of the path, so that none turns by more than `most` radians.
    int parts(double most = std::numbers::pi / 6) const
    {
        double largest = 0;
        for (const auto& m : motions_) largest = std::max(largest, std::abs(m.angle));
        return std::max(1, static_cast<int>(std::ceil(largest / most - 1e-9)));
    }

    /// Rotation of the body of vertex v, axis times angle; none where it has none, or one of fewer than D vertices,
    /// whose rotation is undetermined.
    std::optional<vec3> turn(std::size_t v) const
    {
        if (body_[v] < 0 || sizes_[static_cast<std::size_t>(body_[v])] < D) return std::nullopt;
        const auto& m = motions_[static_cast<std::size_t>(body_[v])];
        return m.angle * m.axis;
    }

    /// Position of the fixed coordinates of vertex v at the fraction t of its path; to the last bit where t is 1.
    vec<D> place(std::size_t v, double t) const
    {
        if (t >= 1) return to_[v];
        if (body_[v] < 0) return from_[v] + t * (to_[v] - from_[v]);
        const auto& m = motions_[static_cast<std::size_t>(body_[v])];
        return m(from_[v], t) + t * m.turned(to_[v] - m(from_[v]), (t - 1) * m.angle);
    }

private:
    /// Connected pinned vertices.
    std::vector<std::vector<std::size_t>> bodies(std::span<const std::array<idx, D + 1>> cells) const
    {
        std::vector<std::size_t> parent(marks_.size());
        std::iota(parent.begin(), parent.end(), std::size_t{0});
        const auto root = [&](std::size_t v)
        {
            while (parent[v] != v) v = parent[v] = parent[parent[v]];
            return v;
        };
        for (const auto& cell : cells)
        {
            std::size_t first = marks_.size();
            for (const idx corner : cell)
            {
                const auto v = static_cast<std::size_t>(corner);
                if (!marks_.all(v)) continue;
                if (first == marks_.size())
                    first = root(v);
                else
                    parent[root(v)] = first;
            }
        }
        std::vector<std::vector<std::size_t>> found;
        std::vector<std::size_t> number(marks_.size(), marks_.size());
        for (std::size_t v = 0; v < marks_.size(); ++v)
        {
            if (!marks_.all(v)) continue;
            auto& n = number[root(v)];
            if (n == marks_.size())
            {
                n = found.size();
                found.emplace_back();
            }
            found[n].push_back(v);
        }
        return found;
    }

    const fixed_marks<D>& marks_;
    const map &from_, &to_;
    std::vector<idx> body_; ///< body of each vertex, or -1
    std::vector<rigid_motion<D>> motions_;
    std::vector<std::size_t> sizes_; ///< numbers of vertices of the bodies
};

} // namespace taut::impl
