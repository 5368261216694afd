// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/core/block_sum.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/hierarchy/star_energy.hpp>

namespace taut::impl
{

/// Area means of the isometric energy; +infinity if a triangle is not surely positive.
struct relaxed_energy
{
    double before, after;
};

/// Map of a surface whose vertices are improved one at a time, where triangles are badly distorted. Every step keeps
/// all triangles certainly positive.
class star_relaxation
{
public:
    /// points: rest positions of the vertices that `numbers` names, one per vertex here; cells: of the surface,
    /// numbered here. fixed: flags of fixed vertices, one per vertex here, or empty. All are referred to.
    star_relaxation(std::span<const vec3> points, std::span<const idx> numbers,
                    std::span<const std::array<idx, 3>> cells, std::span<const char> fixed, unsigned threads)
        : points_(points), numbers_(numbers), cells_(cells), fixed_(fixed), threads_(threads), density_(cells.size())
    {
    }

    /// Sweeps over the vertices of triangles whose isometric energy exceeds `factor` times the area mean,
    /// until there are none or a sweep gains less than 2 %, at most `sweeps` times. Where a triangle is not surely
    /// positive nothing is moved.
    relaxed_energy run(std::span<vec2> x, double factor, int sweeps)
    {
        double before = std::numeric_limits<double>::infinity();
        double energy = mean(x);
        const double first = energy;
        for (int sweep = 0; sweep < sweeps && energy < 0.98 * before; ++sweep)
        {
            const double limit = factor * energy;
            if (std::none_of(density_.begin(), density_.end(), [=](double d) { return d > limit; })) break;
            if (around_.offsets.empty()) find_corners();
            std::vector<char> bad(numbers_.size(), 0);
            for (std::size_t c = 0; c < cells_.size(); ++c)
                if (density_[c] > limit)
                    for (const idx v : cells_[c]) bad[u(v)] = 1;
            for (std::size_t v = 0; v < bad.size(); ++v)
                if (bad[v] && (fixed_.empty() || !fixed_[v])) improve(v, x);
            before = std::exchange(energy, mean(x));
        }
        return {first, energy};
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    const vec3& rest(idx v) const { return points_[u(numbers_[u(v)])]; }

    /// Sets the energies of all triangles; their area mean.
    double mean(std::span<const vec2> x)
    {
        struct sums
        {
            double energy = 0, area = 0;
            sums& operator+=(const sums& o)
            {
                energy += o.energy;
                area += o.area;
                return *this;
            }
        };
        const auto add = [&](sums& sum, std::size_t c)
        {
            const auto [i, j, k] = cells_[c];
            const mat2 W = stiff_ideal(rest(j) - rest(i), rest(k) - rest(i));
            const mat2 S = shape_matrix<2>(cells_[c], std::span<const vec2>(x), invert_upper(W));
            const double area = 0.5 * W[0][0] * W[1][1];
            density_[c] = surely_positive(x[u(i)], x[u(j)], x[u(k)])
                              ? energy::isometric{}(element<double, 2>{S, glm::determinant(S), area})
                              : std::numeric_limits<double>::infinity();
            sum.energy += area * density_[c];
            sum.area += area;
        };
        const auto sum = block_sum<sums>(cells_.size(), add, threads_);
        return sum.energy / sum.area;
    }

    /// Triangles of each vertex, as 3 * triangle + corner.
    void find_corners()
    {
        around_.items.resize(3 * cells_.size());
        around_.offsets = counting_sort(
            around_.items.size(), numbers_.size(), [&](std::size_t corner) { return cells_[corner / 3][corner % 3]; },
            [&](std::size_t corner, std::size_t position) { around_.items[position] = static_cast<idx>(corner); },
            threads_);
    }

    /// Finds the neighbours of v counter-clockwise, along the boundary first; returns false if there are too many.
    bool ring_of(std::size_t v, std::array<idx, largest_star>& ring, std::size_t& size, bool& open) const
    {
        std::array<std::array<idx, 2>, largest_star> edge;
        const auto corners = around_.row(static_cast<idx>(v));
        const std::size_t count = corners.size();
        if (count == 0 || count > largest_star) return false;
        for (std::size_t i = 0; i < count; ++i)
        {
            const std::size_t corner = u(corners[i]), k = corner % 3;
            const auto& t = cells_[corner / 3];
            edge[i] = {t[(k + 1) % 3], t[(k + 2) % 3]};
        }
        const auto used = edge.begin() + static_cast<std::ptrdiff_t>(count);
        for (std::size_t i = 0; i < count; ++i) // the first edge is one that no other leads to
            if (std::none_of(edge.begin(), used, [&](const auto& e) { return e[1] == edge[i][0]; }))
                std::swap(edge[0], edge[i]);
        for (std::size_t i = 1; i < count; ++i)
            for (std::size_t j = i + 1; j < count; ++j)
                if (edge[j][0] == edge[i - 1][1]) std::swap(edge[i], edge[j]);
        open = edge[count - 1][1] != edge[0][0];
        size = count + (open ? 1 : 0);
        if (size > largest_star) return false;
        for (std::size_t i = 0; i < count; ++i) ring[i] = edge[i][0];
        if (open) ring[count] = edge[count - 1][1];
        return true;
    }

    void improve(std::size_t v, std::span<vec2> x) const
    {
        std::array<idx, largest_star> neighbour{};
        ring_image ring;
        if (!ring_of(v, neighbour, ring.size, ring.open)) return;
        std::array<vec3, largest_star> spokes;
        for (std::size_t i = 0; i < ring.size; ++i)
        {
            ring.corner[i] = x[u(neighbour[i])];
            spokes[i] = rest(neighbour[i]) - rest(static_cast<idx>(v));
        }
        constexpr int steps = 5;
        relax(star_energy(ring, {spokes.data(), ring.size}), ring, x[v], steps);
    }

    std::span<const vec3> points_;
    std::span<const idx> numbers_;
    std::span<const std::array<idx, 3>> cells_;
    std::span<const char> fixed_;
    unsigned threads_;
    std::vector<double> density_; // of each triangle
    csr around_;                  ///< the corners of each vertex
};

} // namespace taut::impl
