// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/charts/atlas/cutting/flat_surface.hpp>
#include <taut/impl/core/energy/corner_derivatives.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/impl/core/mesh/first_flip.hpp>

namespace taut::impl
{

/// Some triangles of a map around a place, with numbers of their own.
struct map_patch
{
    std::vector<idx> triangles;            ///< of the surface
    std::vector<std::array<idx, 3>> cells; ///< their vertices here
    std::vector<vec2> x;                   ///< one a vertex
    std::vector<idx> slot;                 ///< one a vertex: its number among those that move, or -1
    idx moving = 0;

    double energy(const rest_surface& rest, std::span<const vec2> at) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < cells.size(); ++i)
        {
            const auto u = rest_surface::u;
            const auto& t = cells[i];
            sum += rest.weight[u(triangles[i])] *
                   isometric_energy(rest.inverse[u(triangles[i])], at[u(t[0])], at[u(t[1])], at[u(t[2])]);
            if (!(sum < std::numeric_limits<double>::infinity())) return sum;
        }
        return sum;
    }
};

/// Newton's method on a patch with a Cholesky factorization of its envelope (George, Liu 1981): some hundred unknowns,
/// many times. Keeps its memory.
class patch_newton
{
public:
    /// Lowers the energy of a patch whose map has no flips. Returns it as it is then.
    double run(const rest_surface& rest, map_patch& p, int steps, double tolerance)
    {
        double here = p.energy(rest, p.x);
        if (p.moving == 0 || !(here < std::numeric_limits<double>::infinity())) return here;
        n_ = 2 * static_cast<std::size_t>(p.moving);
        lay_out(p);
        for (int i = 0; i < steps; ++i)
        {
            const double slope = direction(rest, p);
            if (!(slope < 0)) break;
            const double there = search(rest, p, here, slope);
            const double gain = here - there;
            here = there;
            if (!(gain > tolerance * here)) break;
        }
        return here;
    }

    /// Of the factors of the last run.
    std::size_t entries() const { return size_; }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static constexpr int most_ordinary = 64; ///< triangles around a vertex that is no hub

    /// Row i of the lower triangle, from column start_[i] on.
    double* row(std::size_t i) { return matrix_.data() + first_[i]; }

    /// Unknowns in the order of the longer side of the patch: what is coupled lies near the diagonal then. Hubs, which
    /// are coupled with all around, come last.
    void lay_out(map_patch& p)
    {
        vec2 low = p.x.front(), high = low;
        order_.clear();
        degree_.assign(p.x.size(), 0);
        for (const auto& t : p.cells)
            for (const idx v : t) ++degree_[u(v)];
        for (std::size_t v = 0; v < p.x.size(); ++v)
        {
            low = glm::min(low, p.x[v]);
            high = glm::max(high, p.x[v]);
            if (p.slot[v] >= 0) order_.push_back(v);
        }
        const int axis = high.x - low.x < high.y - low.y;
        std::stable_sort(order_.begin(), order_.end(),
                         [&](std::size_t a, std::size_t b)
                         {
                             const bool hub_a = degree_[a] > most_ordinary, hub_b = degree_[b] > most_ordinary;
                             if (hub_a != hub_b) return hub_b;
                             return p.x[a][axis] < p.x[b][axis];
                         });
        for (std::size_t k = 0; k < order_.size(); ++k) p.slot[order_[k]] = static_cast<idx>(k);
        start_.resize(n_);
        for (std::size_t i = 0; i < n_; ++i) start_[i] = i / 2 * 2;
        for (const auto& t : p.cells)
        {
            idx least = p.moving;
            for (const idx v : t)
                if (p.slot[u(v)] >= 0) least = std::min(least, p.slot[u(v)]);
            for (const idx v : t)
                if (const idx k = p.slot[u(v)]; k >= 0)
                    start_[2 * u(k)] = start_[2 * u(k) + 1] = std::min(start_[2 * u(k)], 2 * u(least));
        }
        first_.resize(n_);
        size_ = 0;
        for (std::size_t i = 0; i < n_; ++i)
        {
            first_[i] = size_;
            size_ += i + 1 - start_[i];
        }
    }

    /// Sets step_ and returns the slope along it; 0 where there is none.
    double direction(const rest_surface& rest, const map_patch& p)
    {
        matrix_.assign(size_, 0.0);
        force_.assign(n_, 0.0);
        for (std::size_t i = 0; i < p.cells.size(); ++i) add(rest, p, i);
        step_ = force_;
        if (!factorize()) return 0;
        for (std::size_t i = 0; i < n_; ++i)
        {
            const std::size_t width = i - start_[i];
            step_[i] = (step_[i] - dot(row(i), step_.data() + start_[i], width)) / row(i)[width];
        }
        for (std::size_t i = n_; i-- > 0;)
        {
            const std::size_t width = i - start_[i];
            const double* const own = row(i);
            const double x = step_[i] /= own[width];
            for (std::size_t j = 0; j < width; ++j) step_[start_[i] + j] -= own[j] * x;
        }
        double slope = 0;
        for (std::size_t i = 0; i < n_; ++i) slope -= force_[i] * step_[i];
        return slope;
    }

    void add(const rest_surface& rest, const map_patch& p, std::size_t i)
    {
        const auto& t = p.cells[i];
        std::array<std::size_t, 3> at{};
        bool any = false;
        for (std::size_t k = 0; k < 3; ++k)
        {
            any = any || p.slot[u(t[k])] >= 0;
            at[k] = p.slot[u(t[k])] >= 0 ? 2 * u(p.slot[u(t[k])]) : n_;
        }
        if (!any) return;
        const mat2& inverse = rest.inverse[u(p.triangles[i])];
        const double weight = rest.weight[u(p.triangles[i])];
        const mat2 S = shape_matrix<2>(t, std::span<const vec2>(p.x), inverse);
        const auto psi = energy::isometric::derivatives(norm2(S), glm::determinant(S));
        const auto H = corner_hessian<2>(plane_modes<double>(S, psi, {}).hessian(weight), inverse);
        const auto g = corner_gradient<2>(weight * gradient_by_shape(S, psi.by_I, psi.by_d), inverse);
        for (std::size_t k = 0; k < 3; ++k)
        {
            if (at[k] == n_) continue;
            for (std::size_t r = 0; r < 2; ++r)
            {
                force_[at[k] + r] -= g[k][static_cast<int>(r)];
                for (std::size_t j = 0; j < 3; ++j)
                    if (at[j] <= at[k])
                        for (std::size_t s = 0; s < 2 && at[j] + s <= at[k] + r; ++s)
                            row(at[k] + r)[at[j] + s - start_[at[k]]] += H[2 * k + r][2 * j + s];
            }
        }
    }

    static double dot(const double* a, const double* b, std::size_t n)
    {
        double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
        std::size_t k = 0;
        for (; k + 4 <= n; k += 4)
        {
            s0 += a[k] * b[k];
            s1 += a[k + 1] * b[k + 1];
            s2 += a[k + 2] * b[k + 2];
            s3 += a[k + 3] * b[k + 3];
        }
        for (; k < n; ++k) s0 += a[k] * b[k];
        return (s0 + s1) + (s2 + s3);
    }

    /// L L^T = matrix_, L below and on the diagonal. False if it is not positive definite.
    bool factorize()
    {
        for (std::size_t i = 0; i < n_; ++i)
        {
            double* const own = row(i) - start_[i];
            for (std::size_t j = start_[i]; j < i; ++j)
            {
                const double* const other = row(j) - start_[j];
                const std::size_t from = std::max(start_[i], start_[j]);
                own[j] = (own[j] - dot(own + from, other + from, j - from)) / other[j];
            }
            const double left = own[i] - dot(own + start_[i], own + start_[i], i - start_[i]);
            if (!(left > 1e-13 * own[i])) return false;
            own[i] = std::sqrt(left);
        }
        return true;
    }

    /// The longest step without a flip that lowers the energy enough. Moves the patch.
    double search(const rest_surface& rest, map_patch& p, double here, double slope)
    {
        moved_.assign(p.x.size(), vec2(0.0));
        for (std::size_t v = 0; v < p.x.size(); ++v)
            if (p.slot[v] >= 0) moved_[v] = {step_[2 * u(p.slot[v])], step_[2 * u(p.slot[v]) + 1]};
        double longest = 1 / 0.9;
        for (std::size_t i = 0; i < p.cells.size(); ++i)
        {
            const mat2& inverse = rest.inverse[u(p.triangles[i])];
            longest =
                std::min(longest, first_flip(shape_matrix<2>(p.cells[i], std::span<const vec2>(p.x), inverse),
                                             shape_matrix<2>(p.cells[i], std::span<const vec2>(moved_), inverse)));
        }
        double t = 0.9 * longest;
        for (int halving = 0; halving < 20; ++halving, t /= 2)
        {
            trial_ = p.x;
            for (std::size_t v = 0; v < trial_.size(); ++v) trial_[v] += t * moved_[v];
            if (const double there = p.energy(rest, trial_); there <= here + 1e-4 * t * slope)
            {
                p.x = trial_;
                return there;
            }
        }
        return here;
    }

    std::size_t n_ = 0, size_ = 0;           // unknowns, entries of the envelope
    std::vector<std::size_t> order_;         // of the vertices that move
    std::vector<int> degree_;                // of all vertices, in triangles
    std::vector<std::size_t> start_, first_; // one a row: its first column, where that lies
    std::vector<double> matrix_, force_, step_;
    std::vector<vec2> moved_, trial_;
};

} // namespace taut::impl
