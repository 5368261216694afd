// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/held_marks.hpp>
#include <taut/impl/core/parallel.hpp>
#include <taut/impl/energy/corner_derivatives.hpp>
#include <taut/impl/energy/modes.hpp>
#include <taut/impl/energy/regularized.hpp>
#include <taut/impl/mesh/first_flip.hpp>
#include <taut/impl/sparse/front_cholesky.hpp>
#include <taut/impl/untangle/regularized_newton.hpp>

namespace taut::impl
{

/// Newton's method in the plane with a direct solver.
class triangle_newton final : public regularized_newton<triangle>
{
public:
    explicit triangle_newton(const regularized_problem<triangle>& problem)
        : regularized_newton(problem),
          held_(problem.held),
          solver_(cells_, pinned(held_)),
          blocks_(cells_.size()),
          forces_(cells_.size()),
          first_cell_(held_.size(), cells_.size())
    {
        for (std::size_t c = cells_.size(); c-- > 0;)
            for (const idx v : cells_[c]) first_cell_[u(v)] = c;
    }

    double value(const map& x) override
    {
        constexpr std::size_t block = 2048;
        const energy::regularized<2> f{eps, area_weight_};
        std::vector<double> part((cells_.size() + block - 1) / block, 0.0);
        parallel_for(
            part.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t b = begin; b < end; ++b)
                    for (std::size_t c = b * block; c < std::min(cells_.size(), (b + 1) * block); ++c)
                        part[b] += shapes_[c].weight * f(mapped(x, c));
            },
            0, 2);
        double sum = 0;
        for (const double p : part) sum += p;
        for (const auto& s : springs)
        {
            const vec2 d = x[u(s.vertex)] - s.target;
            sum += glm::dot(s.stiffness, d * d);
        }
        return sum;
    }

    double step(map& x, double here) override
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
        for (const auto& s : springs)
        {
            const std::size_t v = u(s.vertex), c = first_cell_[v];
            const auto corner =
                static_cast<std::size_t>(std::find(cells_[c].begin(), cells_[c].end(), s.vertex) - cells_[c].begin());
            for (std::size_t k = 0; k < 2; ++k)
            {
                blocks_[c][2 * corner + k][2 * corner + k] += 2 * s.stiffness[static_cast<int>(k)];
                force[v][static_cast<int>(k)] -=
                    2 * s.stiffness[static_cast<int>(k)] * (x[v] - s.target)[static_cast<int>(k)];
            }
        }
        hold(force);
        length_ = 0;
        constexpr double shift = 1e-12; // of the diagonal, relative
        if (!solver_.factorize(blocks_, shift, proceed)) return here;
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
        return here;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    static std::vector<char> pinned(const held_marks<2>& held)
    {
        std::vector<char> flags(held.size());
        for (std::size_t v = 0; v < held.size(); ++v) flags[v] = held.all(v);
        return flags;
    }

    /// Sets the triangle's block and the forces on its corners.
    void derivatives(const map& x, std::size_t c)
    {
        const mat2 S = mapped(x, c);
        const auto psi = energy::regularized<2>{eps, area_weight_}.derivatives(norm2(S), glm::determinant(S));
        const double weight = shapes_[c].weight;
        blocks_[c] = corner_hessian<2>(plane_modes<double>(S, psi, {}).hessian(weight), shapes_[c].inverse);
        forces_[c] = corner_gradient<2>(-weight * gradient_by_shape(S, psi.by_I, psi.by_d), shapes_[c].inverse);
    }

    /// Makes the equations of fixed coordinates x = 0; pinned vertices have none.
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

    const held_marks<2>& held_;
    front_cholesky solver_;
    std::vector<front_cholesky::block> blocks_;
    std::vector<std::array<vec2, 3>> forces_;
    std::vector<std::size_t> first_cell_; // of a vertex
};

inline std::unique_ptr<regularized_newton<triangle>> direct_newton(const regularized_problem<triangle>& problem)
{
    return std::make_unique<triangle_newton>(problem);
}

} // namespace taut::impl
