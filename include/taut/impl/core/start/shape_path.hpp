// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/start/gradient_fit.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// The rotation R of F = R S with S symmetric and positive definite, for det F > 0, by Newton's iteration for the polar
/// decomposition (Higham 1986).
template <int D>
mat<D> nearest_rotation(mat<D> F)
{
    for (int k = 0; k < 60; ++k)
    {
        const mat<D> other = glm::transpose(glm::inverse(F));
        const double scale = std::sqrt(std::sqrt(norm2(other) / norm2(F)));
        const mat<D> next = 0.5 * (scale * F + other / scale);
        const double change = norm2(next - F);
        F = next;
        if (change < 1e-28) break;
    }
    return F;
}

/// The axis, of length 1, and the angle of a rotation; in the plane the axis is the normal.
inline std::pair<vec3, double> axis_and_angle(const mat2& R)
{
    return {{0, 0, 1}, std::atan2(R[0][1], R[0][0])};
}
inline std::pair<vec3, double> axis_and_angle(const mat3& R)
{
    const auto q = glm::quat_cast(R);
    const vec3 v(q.x, q.y, q.z);
    const double length = glm::length(v);
    return {length > 0 ? v / length : vec3(0, 0, 1), 2 * std::atan2(length, q.w)};
}

/// The rotation by |w| about w.
template <int D>
mat<D> rotation(const vec3& w)
{
    const double angle = glm::length(w);
    const vec3 axis = angle > 0 ? w / angle : vec3(0, 0, 1);
    mat<D> R(1.0);
    for (int k = 0; k < D; ++k)
        if constexpr (D == 2)
            R[k] = rigid_motion<2>{}.turned(R[k], w.z);
        else
            R[k] = rigid_motion<3>{.axis = axis}.turned(R[k], angle);
    return R;
}

/// Gradients on the path from one shape of a mesh to another: a global rotation, and a rotation and a stretch of each
/// element, F = Q R S, are interpolated separately from the identity, rotations at constant speed about their axes. Of
/// an element's rotation vectors, which differ by whole turns, the one nearest to that of a neighbour is taken (along a
/// minimum spanning tree), so that a bar twisted by a full turn is interpolated as such.
template <class Element>
class shape_path
{
public:
    static constexpr int D = Element::dimension;
    using shape = std::vector<vec<D>>;

    /// Both shapes without inverted elements.
    shape_path(const mesh<Element>& from, const shape& to)
        : cells_(from.cells()), start_(from.points().begin(), from.points().end()), end_(to), poisson_(from, start_)
    {
        const auto fit = fit_rigid_motion(std::span<const vec<D>>(start_), std::span<const vec<D>>(end_));
        whole_ = fit.angle * fit.axis;
        std::vector<mat<D>> turns;
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            const mat<D> F = poisson_.gradient(c, end_);
            turns.push_back(nearest_rotation<D>(F));
            stretch_.push_back(glm::transpose(turns.back()) * F);
        }
        // Axes are lost near whole turns: so from the mean of all turns, which the best rotation is not where some are
        // long.
        const facet_table table = facets(from);
        unwrap(turns, table);
        vec3 mean(0.0);
        for (const vec3& w : turn_) mean += w / double(turn_.size());
        whole_ = nearest_turn(rotation<D>(whole_) * rotation<D>(mean), whole_ + mean);
        unwrap(turns, table);
        // Of the ways that differ by whole turns of the whole: what moves least does not turn around.
        if (const double angle = glm::length(whole_); angle > 0)
        {
            const vec3 axis = whole_ / angle;
            const double turn = 2 * std::numbers::pi;
            whole_ -= turn * std::round(glm::dot(whole_ + turn_[stillest()], axis) / turn) * axis;
        }
    }

    /// Edges from corner 0 of each element at t, 0 to 1, which need not fit together.
    std::vector<mat<D>> edges(double t) const
    {
        std::vector<mat<D>> all;
        for (std::size_t c = 0; c < cells_.size(); ++c) all.push_back(gradient(c, t) * poisson_.edges(c, start_));
        return all;
    }

    /// The shape whose gradients are nearest to those at t, in the mean square by rest measure (a Poisson equation for
    /// each coordinate); its centre moves on a straight line. Elements may be inverted.
    shape draft(double t) const
    {
        shape x(start_.size());
        for (std::size_t v = 0; v < x.size(); ++v) x[v] = start_[v] + t * (end_[v] - start_[v]);
        poisson_.fit([&](std::size_t c) { return gradient(c, t); }, {}, 1e-10, x);
        return x;
    }

private:
    static std::size_t at(idx v) { return static_cast<std::size_t>(v); }

    mat<D> gradient(std::size_t c, double t) const
    {
        const mat<D> S = (1 - t) * mat<D>(1.0) + t * stretch_[c];
        return rotation<D>(t * whole_) * rotation<D>(t * turn_[c]) * S;
    }

    /// Element whose centre moves least.
    std::size_t stillest() const
    {
        std::size_t found = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            vec<D> way(0.0);
            for (const idx v : cells_[c]) way += end_[at(v)] - start_[at(v)];
            if (glm::dot(way, way) < least) least = glm::dot(way, way), found = c;
        }
        return found;
    }

    /// Axis times angle of a rotation, of those that differ by whole turns the nearest to w.
    static vec3 nearest_turn(const mat<D>& R, const vec3& w)
    {
        auto [axis, angle] = axis_and_angle(R);
        if (std::abs(angle) < 1e-6 && glm::length(w) > 1) axis = glm::normalize(w); // a whole turn has any axis
        const double turn = 2 * std::numbers::pi;
        return axis * (angle + turn * std::round((glm::dot(axis, w) - angle) / turn));
    }

    /// Computes turn_, the rotation vectors of R without the global rotation, consistent among neighbours.
    void unwrap(const std::vector<mat<D>>& rotations, const facet_table& table)
    {
        const mat<D> back = glm::transpose(rotation<D>(whole_));
        const auto nearest = [&](std::size_t c, const vec3& w) { return nearest_turn(back * rotations[c], w); };
        const std::size_t n = rotations.size(), sides = static_cast<std::size_t>(Element::corners);
        turn_.assign(n, vec3(0.0));
        std::vector<char> done(n, 0);
        using entry = std::tuple<double, std::size_t, std::size_t>; // distance, element, neighbour that is done
        std::priority_queue<entry, std::vector<entry>, std::greater<>> next;
        const auto finish = [&](std::size_t c, const vec3& turn)
        {
            turn_[c] = turn;
            done[c] = 1;
            for (std::size_t k = 0; k < sides; ++k)
            {
                const idx twin = table.twin[c * sides + k];
                if (twin < 0) continue;
                const auto other = static_cast<std::size_t>(twin) / sides;
                if (!done[other]) next.emplace(glm::length(nearest(other, turn) - turn), other, c);
            }
        };
        // Each component from the element that turns least.
        std::vector<std::pair<double, std::size_t>> roots;
        for (std::size_t c = 0; c < n; ++c) roots.emplace_back(glm::length(nearest(c, vec3(0.0))), c);
        std::sort(roots.begin(), roots.end());
        for (const auto& [angle, root] : roots)
        {
            if (done[root]) continue;
            finish(root, nearest(root, vec3(0.0)));
            while (!next.empty())
            {
                const auto [distance, c, from] = next.top();
                next.pop();
                if (!done[c]) finish(c, nearest(c, turn_[from]));
            }
        }
    }

    std::vector<typename mesh<Element>::cell> cells_;
    shape start_, end_;
    gradient_fit<Element> poisson_; ///< by the measure at the start
    vec3 whole_;                    ///< axis times angle of Q
    std::vector<mat<D>> stretch_;   ///< S
    std::vector<vec3> turn_;        ///< axis times angle of R
};

} // namespace taut::impl
