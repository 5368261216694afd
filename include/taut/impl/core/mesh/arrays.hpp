// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/arrays.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// A number of the user's as ours; what 32 bits do not hold becomes a number that no mesh has.
template <std::integral I>
idx to_idx(I i)
{
    return std::in_range<idx>(i) ? static_cast<idx>(i) : std::numeric_limits<idx>::max();
}

/// Rows of 2 or 3 coordinates as points in space, z = 0 of 2.
template <class Real, int K>
std::vector<vec3> points_in_space(const array_view<Real, K>& rows)
{
    std::vector<vec3> x(rows.rows(), vec3(0.0));
    for (std::size_t v = 0; v < x.size(); ++v)
    {
        const auto row = rows[v];
        for (int k = 0; k < K; ++k) x[v][k] = static_cast<double>(row[static_cast<std::size_t>(k)]);
    }
    return x;
}

/// Returns whether points lie in one plane z = constant, as those of a planar mesh do.
inline bool is_planar(std::span<const vec3> points)
{
    return std::all_of(points.begin(), points.end(), [&](const vec3& p) { return p.z == points.front().z; });
}

/// Rows of vertex numbers as cells.
template <class Index, int K>
std::vector<std::array<idx, static_cast<std::size_t>(K)>> cells_of_rows(const array_view<Index, K>& rows)
{
    std::vector<std::array<idx, static_cast<std::size_t>(K)>> cells(rows.rows());
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
        const auto row = rows[c];
        for (std::size_t k = 0; k < row.size(); ++k) cells[c][k] = to_idx(row[k]);
    }
    return cells;
}

/// Coordinates of points as packed numbers: D doubles per point, without a copy.
template <int D>
std::span<const double> numbers_of(std::span<const vec<D>> x)
{
    static_assert(sizeof(vec<D>) == D * sizeof(double), "GLM's aligned types have gaps");
    return {x.empty() ? nullptr : &x[0].x, static_cast<std::size_t>(D) * x.size()};
}

} // namespace taut::impl
