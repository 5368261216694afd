// SPDX-License-Identifier: MIT
#include "report/shown_mesh.hpp"
#include "shared/at.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>

namespace taut::report
{

using tools::at;

namespace
{

/// Numbers the values that occur from 0, in their order, and replaces them. Returns how many there are.
template <class Value>
idx number(const std::vector<Value>& values, std::vector<idx>& numbers)
{
    std::vector<Value> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    numbers.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        numbers[i] = static_cast<idx>(std::lower_bound(sorted.begin(), sorted.end(), values[i]) - sorted.begin());
    return static_cast<idx>(sorted.size());
}

/// Clustering of vertices of a mesh.
struct clusters
{
    std::vector<idx> of_point, of_place; ///< numbers
    idx points = 0, places = 0;
    std::vector<idx> left; ///< triangles
};

/// cells: along the longest side of the box
clusters cluster(const shown_mesh& m, double cells)
{
    vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const vec3& p : m.points) low = glm::min(low, p), high = glm::max(high, p);
    const vec3 box = high - low;
    const double side = std::max({box.x, box.y, box.z, std::numeric_limits<double>::min()}) / cells;

    clusters c;
    std::vector<std::uint64_t> cube(m.points.size());
    for (std::size_t v = 0; v < cube.size(); ++v)
        for (int k = 0; k < 3; ++k)
            cube[v] =
                cube[v] << 21 | static_cast<std::uint64_t>(std::clamp((m.points[v][k] - low[k]) / side, 0.0, 2e6));
    c.points = number(cube, c.of_point);

    impl::disjoint_sets joined(static_cast<idx>(m.places.size()));
    for (std::size_t t = 0; t < m.cells.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (c.of_point[at(m.cells[t][k])] == c.of_point[at(m.cells[t][(k + 1) % 3])])
                joined.join(m.images[t][k], m.images[t][(k + 1) % 3]);
    std::vector<idx> first(m.places.size());
    for (std::size_t i = 0; i < first.size(); ++i) first[i] = joined.find(static_cast<idx>(i));
    c.places = number(first, c.of_place);

    // Of triangles that have become one, the first is left; those that lie back to back go both.
    struct moved_triangle
    {
        std::array<idx, 3> corners{};
        idx number = 0;
        int side = 1;
    };
    std::vector<moved_triangle> moved;
    for (std::size_t t = 0; t < m.cells.size(); ++t)
    {
        const auto point = [&](std::size_t k) { return c.of_point[at(m.cells[t][k])]; };
        if (point(0) == point(1) || point(1) == point(2) || point(2) == point(0)) continue;
        moved_triangle one;
        one.number = static_cast<idx>(t);
        for (std::size_t k = 0; k < 3; ++k) one.corners[k] = c.of_place[at(m.images[t][k])];
        for (const std::size_t k : {0U, 1U, 0U}) // sorted, by exchanges of neighbours
            if (one.corners[k + 1] < one.corners[k])
            {
                std::swap(one.corners[k], one.corners[k + 1]);
                one.side = -one.side;
            }
        moved.push_back(one);
    }
    std::sort(moved.begin(), moved.end(),
              [](const moved_triangle& a, const moved_triangle& b)
              { return std::tie(a.corners, a.number) < std::tie(b.corners, b.number); });
    for (std::size_t begin = 0, end = 0; begin < moved.size(); begin = end)
    {
        int sides = 0;
        for (end = begin; end < moved.size() && moved[end].corners == moved[begin].corners; ++end)
            sides += moved[end].side;
        if (sides == 0) continue;
        std::size_t taken = begin;
        while ((moved[taken].side > 0) != (sides > 0)) ++taken;
        c.left.push_back(moved[taken].number);
    }
    std::sort(c.left.begin(), c.left.end());
    return c;
}

/// One flag a place: 1 at the end of a chart.
std::vector<char> borders(const shown_mesh& m)
{
    std::vector<std::pair<idx, idx>> sides;
    sides.reserve(3 * m.images.size());
    for (const auto& t : m.images)
        for (std::size_t k = 0; k < 3; ++k) sides.emplace_back(std::minmax(t[k], t[(k + 1) % 3]));
    std::sort(sides.begin(), sides.end());
    std::vector<char> border(m.places.size(), 0);
    for (std::size_t i = 0; i < sides.size(); ++i)
        if ((i == 0 || sides[i] != sides[i - 1]) && (i + 1 == sides.size() || sides[i] != sides[i + 1]))
            border[at(sides[i].first)] = border[at(sides[i].second)] = 1;
    return border;
}

/// Means of clusters, of those points alone that are marked where there are some: outlines stay lines.
template <class Point>
std::vector<Point> means(const std::vector<Point>& points, const std::vector<idx>& cluster, idx clusters,
                         const std::vector<char>& marked)
{
    std::vector<Point> sum(at(clusters), Point(0));
    std::vector<double> count(at(clusters), 0);
    std::vector<char> has(at(clusters), 0);
    for (std::size_t i = 0; i < points.size(); ++i) has[at(cluster[i])] |= marked[i];
    for (std::size_t i = 0; i < points.size(); ++i)
        if (marked[i] == has[at(cluster[i])]) sum[at(cluster[i])] += points[i], ++count[at(cluster[i])];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
    return sum;
}

/// Leaves out points that no triangle uses.
template <class Point>
void drop_unused(std::vector<Point>& points, std::vector<std::array<idx, 3>>& cells)
{
    std::vector<idx> now(points.size(), -1);
    std::vector<Point> used;
    for (auto& cell : cells)
        for (idx& v : cell)
        {
            idx& w = now[at(v)];
            if (w < 0)
            {
                w = static_cast<idx>(used.size());
                used.push_back(points[at(v)]);
            }
            v = w;
        }
    points = std::move(used);
}

} // namespace

shown_mesh::shown_mesh(std::span<const vec3> model, std::span<const std::array<idx, 3>> triangles,
                       std::span<const std::array<vec2, 3>> uv, std::span<const idx> chart)
    : points(model.begin(), model.end()),
      cells(triangles.begin(), triangles.end()),
      images(triangles.size()),
      origins(triangles.size())
{
    std::iota(origins.begin(), origins.end(), idx(0));
    std::vector<std::size_t> corners(3 * cells.size());
    const auto start = impl::counting_sort(
        corners.size(), points.size(), [&](std::size_t c) { return cells[c / 3][c % 3]; },
        [&](std::size_t c, std::size_t place) { corners[place] = c; });
    for (std::size_t v = 0; v < points.size(); ++v)
        for (auto i = at(start[v]); i < at(start[v + 1]); ++i)
        {
            const std::size_t c = corners[i];
            auto same = at(start[v]);
            while (same < i && !(chart[corners[same] / 3] == chart[c / 3] &&
                                 uv[corners[same] / 3][corners[same] % 3] == uv[c / 3][c % 3]))
                ++same;
            if (same < i)
                images[c / 3][c % 3] = images[corners[same] / 3][corners[same] % 3];
            else
            {
                images[c / 3][c % 3] = static_cast<idx>(places.size());
                places.push_back(uv[c / 3][c % 3]);
            }
        }
}

void shown_mesh::simplify(idx most)
{
    if (static_cast<idx>(cells.size()) <= most) return;
    // A closed surface has about twice as many triangles as cubes that it passes through.
    double grid = std::max(2.0, std::sqrt(most / 2.0));
    clusters c = cluster(*this, grid);
    while (static_cast<idx>(c.left.size()) > most && grid > 2)
    {
        grid = std::max(2.0, grid * std::min(0.97, 0.99 * std::sqrt(double(most) / double(c.left.size()))));
        c = cluster(*this, grid);
    }
    if (static_cast<idx>(c.left.size()) > most) c.left.resize(at(most)); // charts without end in one place

    const auto border = borders(*this);
    std::vector<char> seam(points.size(), 0);
    for (std::size_t t = 0; t < cells.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) seam[at(cells[t][k])] |= border[at(images[t][k])];
    points = means(points, c.of_point, c.points, seam);
    places = means(places, c.of_place, c.places, border);
    const auto moved = [&](const std::vector<std::array<idx, 3>>& from, const std::vector<idx>& cluster_of)
    {
        std::vector<std::array<idx, 3>> to;
        for (const idx t : c.left)
            for (idx& v : to.emplace_back(from[at(t)])) v = cluster_of[at(v)];
        return to;
    };
    cells = moved(cells, c.of_point);
    images = moved(images, c.of_place);
    for (std::size_t i = 0; i < c.left.size(); ++i) origins[i] = origins[at(c.left[i])]; // c.left is in order
    origins.resize(c.left.size());
    drop_unused(points, cells);
    drop_unused(places, images);
}

} // namespace taut::report
