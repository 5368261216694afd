// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include <taut/impl/charts/atlas/cutting/flat_surface.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// Two sets of triangles of one chart that lie on each other in the plane, each in one piece.
struct overlap_layers
{
    std::vector<idx> below, above;
    double area = 0; ///< of the smaller one
};

/// Whether two triangles of the plane, both counter-clockwise, have more than a touch in common.
inline bool lie_on_each_other(std::span<const vec2, 3> a, std::span<const vec2, 3> b)
{
    const auto parts = [](std::span<const vec2, 3> s, std::span<const vec2, 3> t)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec2 d = s[(k + 1) % 3] - s[k];
            const double slack = 1e-6 * glm::dot(d, d);
            bool outside = true;
            for (const vec2& p : t) outside = outside && d.x * (p.y - s[k].y) - d.y * (p.x - s[k].x) <= slack;
            if (outside) return true;
        }
        return false;
    };
    return !parts(a, b) && !parts(b, a);
}

/// Whether the unit square at (i, j) is beyond a side of a triangle. Few squares are not beyond one of a needle,
/// however many its box has.
inline bool beyond_a_side(const std::array<vec2, 3>& t, double i, double j)
{
    const vec2 p = t[1] - t[0], q = t[2] - t[0];
    const double turn = p.x * q.y < p.y * q.x ? -1 : 1;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const vec2 d = turn * (t[(k + 1) % 3] - t[k]);
        const vec2 nearest(d.y > 0 ? i : i + 1, d.x > 0 ? j + 1 : j); // to the inside
        if (d.x * (nearest.y - t[k].y) - d.y * (nearest.x - t[k].x) < -1e-9 * (std::abs(d.x) + std::abs(d.y)))
            return true;
    }
    return false;
}

/// A grid of squares of about the size of triangles, and which come into each.
class triangle_grid
{
public:
    triangle_grid(const rest_surface& rest, std::span<const vec2> uv)
    {
        const idx cells = rest.first_span;
        const auto [low, high] = box_about(uv);
        const vec2 extent = high - low;
        constexpr double most = 16, longest = 2000; // squares a triangle, in a row
        low_ = low;
        size_ = std::max({1.5 * std::sqrt(rest.total / std::max<idx>(1, cells)),
                          std::sqrt(extent.x * extent.y / (most * (cells + 1))), std::max(extent.x, extent.y) / longest,
                          1e-300});
        columns_ = 1 + static_cast<idx>(extent.x / size_);
        rows_ = 1 + static_cast<idx>(extent.y / size_);
        std::vector<std::array<idx, 2>> entries; // square, triangle
        for (idx c = 0; c < cells; ++c)
            for_each_square(uv.subspan(3 * rest_surface::u(c)).first<3>(),
                            [&](idx square) {
                                entries.push_back({square, c});
                            });
        inside_.items.resize(entries.size());
        inside_.offsets = counting_sort(
            entries.size(), rest_surface::u(columns_) * rest_surface::u(rows_),
            [&](std::size_t i) { return entries[i][0]; },
            [&](std::size_t i, std::size_t at) { inside_.items[at] = entries[i][1]; });
    }

    /// The triangles that come into each square, ascending.
    const csr& inside() const { return inside_; }

    /// Calls f(triangle) for those that may lie on a triangle, some several times, until it returns true. Returns
    /// whether it did.
    template <class F>
    bool any_near(std::span<const vec2, 3> triangle, F&& f) const
    {
        bool found = false;
        for_each_square(triangle,
                        [&](idx square)
                        {
                            const auto own = inside_.row(square);
                            found = found || std::any_of(own.begin(), own.end(), f);
                        });
        return found;
    }

private:
    /// Calls f(square) for those that a triangle, which may reach beyond the grid, comes into.
    template <class F>
    void for_each_square(std::span<const vec2, 3> uv, F&& f) const
    {
        const std::array<vec2, 3> t = {(uv[0] - low_) / size_, (uv[1] - low_) / size_, (uv[2] - low_) / size_};
        const vec2 least = glm::max(glm::min(glm::min(t[0], t[1]), t[2]), vec2(0.0));
        const vec2 most = glm::min(glm::max(glm::max(t[0], t[1]), t[2]), vec2(columns_ - 1, rows_ - 1));
        if (!(least.x <= most.x && least.y <= most.y)) return;
        const auto whole = [](double x) { return static_cast<idx>(x); };
        for (idx i = whole(least.x); i <= whole(most.x); ++i)
            for (idx j = whole(least.y); j <= whole(most.y); ++j)
                if (!beyond_a_side(t, i, j)) f(i * rows_ + j);
    }

    vec2 low_{0.0};
    double size_ = 1;
    idx columns_ = 1, rows_ = 1;
    csr inside_; // of each square, columns one after the other
};

/// Two triangles of a chart, the lower number first.
using triangle_pair = std::array<idx, 2>;

/// Pairs of triangles of the same chart that lie on each other, ascending; found by a grid.
/// chart: one label a triangle
inline std::vector<triangle_pair> overlapping_pairs(const rest_surface& rest, std::span<const vec2> uv,
                                                    std::span<const idx> chart)
{
    const auto u = rest_surface::u;
    const triangle_grid grid(rest, uv);
    constexpr idx block = 4096; // squares
    std::vector<std::vector<triangle_pair>> found(u((grid.inside().rows() + block - 1) / block));
    const auto look_into = [&](idx square, std::vector<triangle_pair>& pairs)
    {
        const auto own = grid.inside().row(square);
        for (std::size_t i = 0; i < own.size(); ++i)
            for (std::size_t j = i + 1; j < own.size(); ++j)
                if (chart[u(own[i])] == chart[u(own[j])] &&
                    lie_on_each_other(uv.subspan(3 * u(own[i])).first<3>(), uv.subspan(3 * u(own[j])).first<3>()))
                    pairs.push_back({own[i], own[j]});
    };
    parallel_for(
        found.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t b = begin; b < end; ++b)
                for (idx square = block * static_cast<idx>(b);
                     square < std::min(block * static_cast<idx>(b + 1), grid.inside().rows()); ++square)
                    look_into(square, found[b]);
        },
        0, 2);
    std::vector<triangle_pair> pairs;
    for (const auto& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Sorts the triangles of two layers, leaves out those in both, which part nothing (a spiral lies on itself), and
/// measures the smaller layer.
inline void separate(const rest_surface& rest, overlap_layers& layers)
{
    for (auto* side : {&layers.below, &layers.above})
    {
        std::sort(side->begin(), side->end());
        side->erase(std::unique(side->begin(), side->end()), side->end());
    }
    std::vector<idx> both;
    std::set_intersection(layers.below.begin(), layers.below.end(), layers.above.begin(), layers.above.end(),
                          std::back_inserter(both));
    std::array<double, 2> area{};
    for (std::size_t k = 0; k < 2; ++k)
    {
        auto& side = k == 0 ? layers.below : layers.above;
        std::erase_if(side, [&](idx c) { return std::binary_search(both.begin(), both.end(), c); });
        for (const idx c : side) area[k] += rest.area[rest_surface::u(c)];
    }
    layers.area = std::min(area[0], area[1]);
}

/// The layers of each overlap: pairs (a, b) and (a', b') belong together where a' is a neighbour of a in the chart, or
/// b' one of b. Largest first.
/// half: overlapping_pairs() of the charts
inline std::vector<overlap_layers> layers_of(const rest_surface& rest, const flat_surface& flat,
                                             std::span<const triangle_pair> half)
{
    const auto u = rest_surface::u;
    std::vector<triangle_pair> pairs;
    for (const auto& [a, b] : half)
    {
        pairs.push_back({a, b});
        pairs.push_back({b, a});
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<idx> row(rest.surface.cells().size() + 1, 0); // the first pair of each triangle
    for (const auto& [a, b] : pairs) ++row[u(a) + 1];
    std::partial_sum(row.begin(), row.end(), row.begin());
    const auto find = [&](idx a, idx b)
    {
        for (idx k = row[u(a)]; k < row[u(a) + 1]; ++k)
            if (pairs[u(k)][1] == b) return k;
        return idx(-1);
    };
    disjoint_sets sets(static_cast<idx>(pairs.size()));
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (idx s = 3 * pairs[i][0]; s < 3 * pairs[i][0] + 3; ++s)
        {
            if (rest.twin(s) < 0 || flat.seam[u(s)]) continue;
            const idx a = rest.twin(s) / 3, b = pairs[i][1], own = find(b, pairs[i][0]);
            if (const idx k = find(a, b); k >= 0) sets.join(static_cast<idx>(i), k);
            if (const idx k = find(b, a); k >= 0) sets.join(own, k);
            for (idx t = 3 * b; t < 3 * b + 3; ++t) // of equal triangles on each other both are left at once
                if (rest.twin(t) >= 0 && !flat.seam[u(t)])
                    if (const idx k = find(a, rest.twin(t) / 3); k >= 0) sets.join(static_cast<idx>(i), k);
        }
    std::vector<overlap_layers> result;
    std::vector<idx> number(pairs.size(), -1);
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        const idx root = sets.find(static_cast<idx>(i));
        const idx other = sets.find(find(pairs[i][1], pairs[i][0]));
        const idx own = std::min(root, other);
        if (root != own) continue; // of two sets that are each other turned over, one
        if (number[u(own)] < 0)
        {
            number[u(own)] = static_cast<idx>(result.size());
            result.emplace_back();
        }
        result[u(number[u(own)])].below.push_back(pairs[i][0]);
        result[u(number[u(own)])].above.push_back(pairs[i][1]);
    }
    for (auto& r : result) separate(rest, r);
    std::stable_sort(result.begin(), result.end(),
                     [](const overlap_layers& a, const overlap_layers& b) { return a.area > b.area; });
    return result;
}

inline std::vector<overlap_layers> find_overlaps(const rest_surface& rest, const flat_surface& flat)
{
    const auto chart = pieces_between(rest.facets, flat.seam).first;
    return layers_of(rest, flat, overlapping_pairs(rest, flat.uv, chart));
}

} // namespace taut::impl
