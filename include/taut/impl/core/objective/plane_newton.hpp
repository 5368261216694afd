// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/constrain/point_constraints.hpp>
#include <taut/impl/core/energy/corner_derivatives.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/impl/core/mesh/first_flip.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/target_shape.hpp>
#include <taut/impl/core/sparse/front_cholesky.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Derivative along d of an energy with these forces, minus its gradient.
inline double slope_along(std::span<const vec2> force, std::span<const vec2> d)
{
    double slope = 0;
    for (std::size_t v = 0; v < d.size(); ++v) slope -= glm::dot(force[v], d[v]);
    return slope;
}

/// Longest step from x along d: `most`, or 0.9 of the way to the first flip of a triangle.
inline double longest_step(std::span<const std::array<idx, 3>> cells, std::span<const vec2> x, std::span<const vec2> d,
                           double most)
{
    const auto edges = [](const std::array<idx, 3>& t, std::span<const vec2> p)
    {
        const vec2& first = p[static_cast<std::size_t>(t[0])];
        return mat2(p[static_cast<std::size_t>(t[1])] - first, p[static_cast<std::size_t>(t[2])] - first);
    };
    double flip = std::numeric_limits<double>::infinity();
    for (const auto& t : cells) flip = std::min(flip, first_flip(edges(t, x), edges(t, d)));
    return std::min(most, 0.9 * flip);
}

/// Newton's method on the host for a sum over triangles of the plane, with the Hessian of each one projected to
/// positive semi-definite, a direct solver, and the Armijo condition (Nocedal & Wright, Algorithm 3.1). For some
/// thousand triangles, where it is faster than a device.
///
/// Energy is a function of the triangle that is not changed by rotations: value(corners, S), +infinity outside of its
/// domain, derivatives(|S|^2, det S) as invariant_derivatives, and barrier(), whether flipped triangles are outside.
template <class Energy>
class plane_newton
{
public:
    /// held: coordinates that are not moved, of each vertex. All are referred to.
    plane_newton(std::span<const std::array<idx, 3>> cells, std::span<const target_shape<2>> shapes,
                 const fixed_marks<2>& held)
        : cells_(cells),
          shapes_(shapes),
          held_(held),
          solver_(cells, pinned(held)),
          blocks_(cells.size()),
          forces_(cells.size())
    {
    }

    /// Value of the sum and of springs.
    double value(std::span<const vec2> x, const Energy& energy, std::span<const directed_spring<2>> springs = {}) const
    {
        constexpr std::size_t block = 2048;
        std::vector<double> part((cells_.size() + block - 1) / block, 0.0);
        parallel_for(
            part.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t b = begin; b < end; ++b)
                    for (std::size_t c = b * block; c < std::min(cells_.size(), (b + 1) * block); ++c)
                        part[b] += shapes_[c].weight * energy.value(corners(x, c), mapped(x, c));
            },
            0, 2);
        double sum = std::accumulate(part.begin(), part.end(), 0.0);
        for (const auto& s : springs)
        {
            const vec2 d = x[u(s.vertex)] - s.target;
            sum += glm::dot(s.stiffness, d * d);
        }
        return sum;
    }

    /// One step from x, whose value is `here`, with decrease. Returns the new value, or the old one if no step
    /// decreases it, or once `proceed` has returned false.
    double step(std::vector<vec2>& x, double here, const Energy& energy,
                std::span<const directed_spring<2>> springs = {}, const std::function<bool()>& proceed = {})
    {
        length_ = 0;
        const auto force = linearize(x, energy, springs);
        constexpr double shift = 1e-12; // of the diagonal, relative
        if (!solver_.factorize(blocks_, shift, proceed)) return here;
        const std::vector<vec2> d = solver_.solve(force);
        const double slope = slope_along(force, d);
        if (!(slope < 0)) return here;
        double t = energy.barrier() ? longest_step(cells_, x, d, 1) : 1;
        std::vector<vec2> trial(x.size());
        for (int halving = 0; halving < 40; ++halving, t /= 2)
        {
            for (std::size_t v = 0; v < x.size(); ++v) trial[v] = x[v] + t * d[v];
            if (const double there = value(trial, energy, springs); there <= here + 1e-4 * t * slope)
            {
                x = std::move(trial);
                length_ = t;
                return there;
            }
        }
        return here;
    }

    double last_length() const { return length_; } ///< of the last step, in Newton steps

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    static std::vector<char> pinned(const fixed_marks<2>& held)
    {
        std::vector<char> flags(held.size());
        for (std::size_t v = 0; v < held.size(); ++v) flags[v] = held.all(v);
        return flags;
    }

    std::array<vec2, 3> corners(std::span<const vec2> x, std::size_t c) const
    {
        const auto& t = cells_[c];
        return {x[u(t[0])], x[u(t[1])], x[u(t[2])]};
    }
    mat2 mapped(std::span<const vec2> x, std::size_t c) const
    {
        return shape_matrix<2>(cells_[c], x, shapes_[c].inverse);
    }

    /// Sets the blocks of triangles and springs; returns the forces on vertices.
    std::vector<vec2> linearize(std::span<const vec2> x, const Energy& energy,
                                std::span<const directed_spring<2>> springs)
    {
        parallel_for(
            cells_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t c = begin; c < end; ++c) derivatives(x, energy, c);
            },
            0, 1024);
        std::vector<vec2> force(x.size(), vec2(0.0));
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k) force[u(cells_[c][k])] += forces_[c][k];
        if (!springs.empty() && first_corner_.empty()) find_first_corners();
        for (const auto& s : springs)
        {
            const std::size_t v = u(s.vertex), c = first_corner_[v] / 3, corner = first_corner_[v] % 3;
            for (std::size_t k = 0; k < 2; ++k)
                blocks_[c][2 * corner + k][2 * corner + k] += 2 * s.stiffness[static_cast<int>(k)];
            force[v] -= 2.0 * s.stiffness * (x[v] - s.target);
        }
        hold(force);
        return force;
    }

    /// Sets the triangle's block and the forces on its corners.
    void derivatives(std::span<const vec2> x, const Energy& energy, std::size_t c)
    {
        const mat2 S = mapped(x, c);
        const auto psi = energy.derivatives(norm2(S), glm::determinant(S));
        const double weight = shapes_[c].weight;
        blocks_[c] = corner_hessian<2>(plane_modes<double>(S, psi, {}).hessian(weight), shapes_[c].inverse);
        forces_[c] = corner_gradient<2>(-weight * gradient_by_shape(S, psi.by_I, psi.by_d), shapes_[c].inverse);
    }

    /// Makes the equations of fixed coordinates x = 0; pinned vertices have none.
    void hold(std::vector<vec2>& force)
    {
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (std::size_t i = 0; i < 6; ++i)
            {
                const std::size_t v = u(cells_[c][i / 2]);
                if (held_.all(v) || !held_.test(v, static_cast<int>(i % 2))) continue;
                for (std::size_t j = 0; j < 6; ++j) blocks_[c][i][j] = blocks_[c][j][i] = 0;
                blocks_[c][i][i] = 1;
            }
        for (std::size_t v = 0; v < force.size(); ++v)
            for (int k = 0; k < 2; ++k)
                if (held_.test(v, k)) force[v][k] = 0;
    }

    /// Some corner of each vertex, to which its springs are added, as 3 * triangle + corner.
    void find_first_corners()
    {
        first_corner_.assign(held_.size(), 0);
        for (std::size_t corner = 3 * cells_.size(); corner-- > 0;)
            first_corner_[u(cells_[corner / 3][corner % 3])] = corner;
    }

    std::span<const std::array<idx, 3>> cells_;
    std::span<const target_shape<2>> shapes_;
    const fixed_marks<2>& held_;
    front_cholesky solver_;
    std::vector<front_cholesky::block> blocks_;
    std::vector<std::array<vec2, 3>> forces_;
    std::vector<std::size_t> first_corner_; // of a vertex; none before there are springs
    double length_ = 0;
};

} // namespace taut::impl
