// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/held_marks.hpp>
#include <taut/core/parallel.hpp>
#include <taut/energy/corner_derivatives.hpp>
#include <taut/energy/modes.hpp>
#include <taut/energy/regularized.hpp>
#include <taut/mesh/first_flip.hpp>
#include <taut/sparse/front_cholesky.hpp>
#include <taut/start/target_shapes.hpp>

namespace taut::detail
{

/// Newton's method on sum over triangles of weight * regularised energy, plus springs: the Hessian of each triangle is
/// projected to positive semi-definite, the step comes from a direct solver.
class triangle_newton
{
public:
    struct spring
    {
        std::size_t vertex;
        vec2 target, stiffness; ///< pulls with sum of stiffness (x - target)^2, a coordinate each
    };

    /// held: one a vertex, these coordinates are not moved. Cells and held are referred to.
    triangle_newton(std::span<const std::array<idx, 3>> cells, const held_marks<2>& held)
        : cells_(cells),
          held_(held),
          solver_(cells, pinned(held)),
          blocks_(cells.size()),
          forces_(cells.size()),
          first_cell_(held.size(), cells.size())
    {
        for (std::size_t c = cells.size(); c-- > 0;)
            for (const idx v : cells[c]) first_cell_[u(v)] = c;
    }

    double eps = 0;                      ///< 0: the energy is a barrier
    double area_weight = 1;              ///< of det + 1 / det against the shape
    std::vector<target_shape<2>> shapes; ///< one a triangle
    std::vector<spring> springs;
    std::function<bool()> proceed; ///< asked within a step, if given; once it says no, nothing moves

    mat2 mapped(std::span<const vec2> x, std::size_t c) const
    {
        return shape_matrix<2>(cells_[c], x, shapes[c].inverse);
    }

    double value(std::span<const vec2> x) const
    {
        constexpr std::size_t block = 2048;
        const energy::regularized<2> f{eps, area_weight};
        std::vector<double> part((cells_.size() + block - 1) / block, 0.0);
        parallel_for(
            part.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t b = begin; b < end; ++b)
                    for (std::size_t c = b * block; c < std::min(cells_.size(), (b + 1) * block); ++c)
                        part[b] += shapes[c].weight * f(mapped(x, c));
            },
            0, 2);
        double sum = 0;
        for (const double p : part) sum += p;
        for (const spring& s : springs)
        {
            const vec2 d = x[s.vertex] - s.target;
            sum += glm::dot(s.stiffness, d * d);
        }
        return sum;
    }

    /// Smallest det S.
    double least_det(std::span<const vec2> x) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < cells_.size(); ++c) least = std::min(least, glm::determinant(mapped(x, c)));
        return least;
    }

    /// One step from x with decrease; returns the new value, or the old one if no step decreases it. `shift` is added
    /// to the Hessian, relative to its diagonal.
    double step(std::vector<vec2>& x, double here, double shift = 1e-12)
    {
        parallel_for(
            cells_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t c = begin; c < end; ++c) derivatives(x, c);
            },
            0, 1024);
        std::vector<vec2> force(x.size(), vec2(0.0));
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k) force[u(cells_[c][k])] += forces_[c][k];
        for (const spring& s : springs)
        {
            const std::size_t c = first_cell_[s.vertex];
            const auto corner = static_cast<std::size_t>(
                std::find(cells_[c].begin(), cells_[c].end(), static_cast<idx>(s.vertex)) - cells_[c].begin());
            for (std::size_t k = 0; k < 2; ++k)
            {
                blocks_[c][2 * corner + k][2 * corner + k] += 2 * s.stiffness[static_cast<int>(k)];
                force[s.vertex][static_cast<int>(k)] -=
                    2 * s.stiffness[static_cast<int>(k)] * (x[s.vertex] - s.target)[static_cast<int>(k)];
            }
        }
        hold(force);
        if (!solver_.factorize(blocks_, shift, proceed))
        {
            length_ = 0;
            return here;
        }
        const std::vector<vec2> d = solver_.solve(force);
        double slope = 0;
        for (std::size_t v = 0; v < x.size(); ++v) slope -= glm::dot(force[v], d[v]);
        if (!(slope < 0)) return here;

        double t = 1;
        if (eps == 0)
            for (std::size_t c = 0; c < cells_.size(); ++c)
                t = std::min(t, 0.9 * first_flip(mapped(x, c), mapped(d, c)));
        std::vector<vec2> trial(x.size());
        for (int halving = 0; halving < 40; ++halving, t /= 2)
        {
            for (std::size_t v = 0; v < x.size(); ++v) trial[v] = x[v] + t * d[v];
            if (const double there = value(trial); there <= here + 1e-4 * t * slope)
            {
                x = std::move(trial);
                length_ = t;
                return there;
            }
        }
        length_ = 0;
        return here;
    }

    double last_length() const { return length_; } ///< of the last step, in Newton steps

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    static std::vector<char> pinned(const held_marks<2>& held)
    {
        std::vector<char> flags(held.size());
        for (std::size_t v = 0; v < held.size(); ++v) flags[v] = held.all(v);
        return flags;
    }

    /// Sets the triangle's block and the forces on its corners.
    void derivatives(std::span<const vec2> x, std::size_t c)
    {
        const mat2 S = mapped(x, c);
        const auto psi = energy::regularized<2>{eps, area_weight}.derivatives(norm2(S), glm::determinant(S));
        const double weight = shapes[c].weight;
        blocks_[c] = corner_hessian<2>(plane_modes<double>(S, psi, true).hessian(weight), shapes[c].inverse);
        forces_[c] = corner_gradient<2>(-weight * gradient_by_shape(S, psi.by_I, psi.by_d), shapes[c].inverse);
    }

    /// Makes the equations of held coordinates x = 0; pinned vertices have none.
    void hold(std::vector<vec2>& force)
    {
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (std::size_t i = 0; i < 6; ++i)
                if (held_.test(u(cells_[c][i / 2]), static_cast<int>(i % 2)))
                {
                    for (std::size_t j = 0; j < 6; ++j) blocks_[c][i][j] = blocks_[c][j][i] = 0;
                    blocks_[c][i][i] = 1;
                    force[u(cells_[c][i / 2])][static_cast<int>(i % 2)] = 0;
                }
    }

    std::span<const std::array<idx, 3>> cells_;
    const held_marks<2>& held_;
    front_cholesky solver_;
    std::vector<front_cholesky::block> blocks_;
    std::vector<std::array<vec2, 3>> forces_;
    std::vector<std::size_t> first_cell_; // of a vertex
    double length_ = 0;
};

} // namespace taut::detail
