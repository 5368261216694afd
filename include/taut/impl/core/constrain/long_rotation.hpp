// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/rigid_motion.hpp>

namespace taut::impl
{

/// Rotation of pinned vertices by so much that their places do not tell how they get there: by half a turn and more.
template <int D>
class long_rotation
{
public:
    using map = std::vector<vec<D>>;

    /// Returns whether places alone would leave a rotation open.
    static bool is_long(const rigid_motion<D>& motion) { return std::abs(motion.angle) > 0.9 * std::numbers::pi; }

    /// from: one place a vertex, before the motion.
    long_rotation(std::span<const idx> vertices, map from, const rigid_motion<D>& motion)
        : vertices_(vertices.begin(), vertices.end()), from_(std::move(from)), motion_(motion)
    {
    }

    const std::vector<idx>& vertices() const { return vertices_; }

    /// Angle of the motion, and how much of it is done; radians.
    double angle() const { return motion_.angle; }
    double turned() const { return done_ * motion_.angle; }

    /// Number of parts of what is left of it, none of which is long.
    int parts() const
    {
        constexpr double most = 5 * std::numbers::pi / 6;
        return std::max(1, static_cast<int>(std::ceil((1 - done_) * std::abs(motion_.angle) / most - 1e-9)));
    }

    /// Finds how much of it is done in a map: the fraction nearest to its places, from the last known one on to half a
    /// turn more.
    void find_done(const map& x)
    {
        const double to = std::min(1.0, done_ + std::numbers::pi / std::abs(motion_.angle));
        constexpr int steps = 64;
        double best = done_, least = off(x, done_), width = (to - done_) / steps;
        const double first = done_;
        for (int k = 1; k <= steps; ++k)
            if (const double t = first + k * width, here = off(x, t); here < least) best = t, least = here;
        for (; width > 1e-12; width /= 2)
            for (const double t : {std::max(first, best - width), std::min(to, best + width)})
                if (const double here = off(x, t); here < least) best = t, least = here;
        done_ = best;
    }

    /// Notes that the fraction t of what was left is done.
    void proceed(double t) { done_ += t * (1 - done_); }

    /// Sets the places of its vertices at the fraction t of what is left, from a map to targets.
    void place(double t, const map& from, const map& to, map& x) const
    {
        for (std::size_t i = 0; i < vertices_.size(); ++i)
        {
            const auto v = static_cast<std::size_t>(vertices_[i]);
            const auto at = [&](double part) { return motion_(from_[i], part); };
            x[v] = at(done_ + t * (1 - done_)) + (1 - t) * (from[v] - at(done_)) + t * (to[v] - at(1));
        }
    }

    /// Leaves a vertex out.
    void remove(idx v)
    {
        const auto at = std::find(vertices_.begin(), vertices_.end(), v);
        if (at == vertices_.end()) return;
        from_.erase(from_.begin() + (at - vertices_.begin()));
        vertices_.erase(at);
    }

private:
    double off(const map& x, double t) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < vertices_.size(); ++i)
        {
            const vec<D> d = x[static_cast<std::size_t>(vertices_[i])] - motion_(from_[i], t);
            sum += glm::dot(d, d);
        }
        return sum;
    }

    std::vector<idx> vertices_;
    map from_;
    rigid_motion<D> motion_;
    double done_ = 0; ///< fraction
};

} // namespace taut::impl
