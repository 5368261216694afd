// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <taut/mesh.hpp>

/// Small generated meshes for tests: good disks first, then the ones a validator must refuse.
namespace taut::test
{

using triangles = std::vector<std::array<taut::idx, 3>>;

/// The triangles of an nx by ny grid of quads over (nx + 1)(ny + 1) vertices, counter-clockwise; vertex = j (nx+1) + i.
inline triangles grid_cells(int nx, int ny)
{
    triangles cells;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
        {
            const taut::idx a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
            // Alternating diagonals keep the valences between 4 and 8.
            if ((i + j) % 2 == 0)
                cells.insert(cells.end(), {{a, b, d}, {a, d, c}});
            else
                cells.insert(cells.end(), {{a, b, c}, {b, d, c}});
        }
    return cells;
}

/// A planar disk: the unit square, nx by ny quads of two triangles.
inline mesh<triangle> grid(int nx, int ny)
{
    std::vector<vec3> points;
    for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) points.emplace_back(double(i) / nx, double(j) / ny, 0.0);
    return {std::move(points), grid_cells(nx, ny)};
}

/// A disk of n rings around a pole: vertex 0 is the pole, ring r has 6 r vertices. place(r / n, angle) is
/// its position in space.
template <class Place>
mesh<triangle> rings(int n, Place place)
{
    std::vector<vec3> points = {place(0.0, 0.0)};
    triangles cells;
    taut::idx inner = 0;
    for (int r = 1; r <= n; ++r)
    {
        const auto outer = static_cast<taut::idx>(points.size());
        const int m = 6 * r, k = 6 * (r - 1);
        for (int i = 0; i < m; ++i) points.push_back(place(double(r) / n, 2 * std::numbers::pi * i / m));
        // Each of the six sectors has r outer and r - 1 inner edges.
        for (int s = 0; s < 6; ++s)
            for (int i = 0; i < r; ++i)
            {
                const taut::idx a = outer + (s * r + i) % m, b = outer + (s * r + i + 1) % m;
                const taut::idx c = k == 0 ? inner : inner + (s * (r - 1) + i) % k;
                cells.push_back({a, b, c});
                if (i + 1 < r) cells.push_back({b, inner + (s * (r - 1) + i + 1) % k, c});
            }
        inner = outer;
    }
    return {std::move(points), std::move(cells)};
}

/// A flat disk of radius 1 with n rings.
inline mesh<triangle> flat_disk(int n)
{
    return rings(n, [](double r, double a) { return vec3(r * std::cos(a), r * std::sin(a), 0.0); });
}

/// A spherical cap of the unit sphere with n rings; `opening` is the angle from the pole to the rim (pi/2: hemisphere).
inline mesh<triangle> cap(int n, double opening = std::numbers::pi / 2)
{
    return rings(n,
                 [=](double r, double a)
                 {
                     const double t = r * opening;
                     return vec3(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
                 });
}

/// A bumpy disk in space with irregular valences (3 to about 12): a grid with jittered points, waves, diagonals
/// by lot and 1-to-3 splits. The same `seed` always gives the same mesh.
inline mesh<triangle> bumpy(int n, double height = 0.15, std::uint32_t seed = 1)
{
    std::mt19937 rng(seed);
    const auto uniform = [&rng] { return double(rng()) / 4294967296.0; }; // (std distributions differ by library)
    const auto lift = [=](double x, double y)
    { return vec3(x, y, height * std::sin(7 * x + 1) * std::cos(9 * y) + 0.5 * height * std::sin(17 * x * y + seed)); };
    std::vector<vec3> points;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
        {
            const bool rim = i == 0 || j == 0 || i == n || j == n;
            const double dx = rim ? 0.0 : 0.5 * (uniform() - 0.5), dy = rim ? 0.0 : 0.5 * (uniform() - 0.5);
            points.push_back(lift((i + dx) / n, (j + dy) / n));
        }
    triangles cells;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
            const taut::idx a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            // The jitter is below 1/4 of the spacing, so that both diagonals of a quad are good: pick one by lot.
            if (uniform() < 0.5)
                cells.insert(cells.end(), {{a, b, d}, {a, d, c}});
            else
                cells.insert(cells.end(), {{a, b, c}, {b, d, c}});
        }
    const std::size_t coarse = cells.size();
    for (std::size_t t = 0; t < coarse; ++t)
    {
        if (uniform() >= 0.15) continue;
        const auto [a, b, c] = cells[t];
        const vec3 m = (points[std::size_t(a)] + points[std::size_t(b)] + points[std::size_t(c)]) / 3.0;
        const auto v = static_cast<taut::idx>(points.size());
        points.push_back(lift(m.x, m.y));
        cells[t] = {a, b, v};
        cells.insert(cells.end(), {{b, c, v}, {c, a, v}});
    }
    return {std::move(points), std::move(cells)};
}

/// A tube of radius 1 that is closed at z = 0 and open at z = 2 aspect (a disk): hard for long aspects.
inline mesh<triangle> tube(int around, double aspect)
{
    const int along = std::max(1, int(std::lround(2 * aspect * around / (2 * std::numbers::pi))));
    std::vector<vec3> points = {vec3(0.0, 0.0, 0.0)};
    triangles cells;
    for (int j = 0; j <= along; ++j)
        for (int i = 0; i < around; ++i)
        {
            const double a = 2 * std::numbers::pi * i / around;
            points.emplace_back(std::cos(a), std::sin(a), 2 * aspect * j / along);
        }
    const auto at = [=](int i, int j) { return taut::idx(1 + j * around + i % around); };
    for (int i = 0; i < around; ++i) cells.push_back({0, at(i + 1, 0), at(i, 0)}); // normals point out
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < around; ++i)
            cells.insert(cells.end(),
                         {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, {at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    return {std::move(points), std::move(cells)};
}

inline mesh<triangle> single_triangle()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0}}, {{0, 1, 2}}};
}

/// n triangles around vertex 0; its first and last spokes are boundary unless `closed`.
inline mesh<triangle> fan(int n, bool closed = false)
{
    std::vector<vec3> points = {vec3(0.0)};
    triangles cells;
    const int rim = closed ? n : n + 1;
    for (int i = 0; i < rim; ++i)
    {
        const double a = (closed ? 2 : 1.5) * std::numbers::pi * i / n;
        points.emplace_back(std::cos(a), std::sin(a), 0.0);
    }
    for (int i = 0; i < n; ++i) cells.push_back({0, 1 + i, 1 + (i + 1) % rim});
    return {std::move(points), std::move(cells)};
}

// ---- Not disks
// -------------------------------------------------------------------------------------------------------

/// Two boundary loops: n segments between radius 1 and 2.
inline mesh<triangle> annulus(int n)
{
    std::vector<vec3> points;
    for (int i = 0; i < n; ++i)
        for (const double r : {1.0, 2.0})
        {
            const double a = 2 * std::numbers::pi * i / n;
            points.emplace_back(r * std::cos(a), r * std::sin(a), 0.0);
        }
    triangles cells;
    for (int i = 0; i < n; ++i)
    {
        const taut::idx a = 2 * i, b = a + 1, c = 2 * ((i + 1) % n), d = c + 1;
        cells.insert(cells.end(), {{a, b, d}, {a, d, c}});
    }
    return {std::move(points), std::move(cells)};
}

/// A strip of n quads with a half twist: no consistent orientation exists.
inline mesh<triangle> moebius(int n)
{
    std::vector<vec3> points;
    for (int i = 0; i < n; ++i)
        for (const double w : {-0.3, 0.3})
        {
            const double a = 2 * std::numbers::pi * i / n, r = 1 + w * std::cos(a / 2);
            points.emplace_back(r * std::cos(a), r * std::sin(a), w * std::sin(a / 2));
        }
    triangles cells;
    for (int i = 0; i < n; ++i)
    {
        const taut::idx a = 2 * i, b = a + 1;
        const taut::idx c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0; // the seam swaps the sides
        cells.insert(cells.end(), {{a, b, d}, {a, d, c}});
    }
    return {std::move(points), std::move(cells)};
}

/// Closed, convex: eight triangles.
inline mesh<triangle> octahedron()
{
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// A torus of n by n quads; with `hole` one quad is left out, which gives one boundary loop and one handle.
inline mesh<triangle> torus(int n, bool hole)
{
    std::vector<vec3> points;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
            const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / n, r = 3 + std::cos(b);
            points.emplace_back(r * std::cos(a), r * std::sin(a), std::sin(b));
        }
    const auto at = [=](int i, int j) { return taut::idx((j % n) * n + i % n); };
    triangles cells;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            if (!hole || i > 0 || j > 0)
                cells.insert(cells.end(),
                             {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, {at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    return {std::move(points), std::move(cells)};
}

/// Two triangles that meet in vertex 2 only.
inline mesh<triangle> bowtie()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 3, 4}}};
}

/// Three triangles on the edge 0-1.
inline mesh<triangle> three_on_an_edge()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}, {0.5, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
}

/// Two grids side by side without a common vertex.
inline mesh<triangle> two_components()
{
    const auto g = grid(2, 2);
    std::vector<vec3> points = g.points();
    triangles cells = g.cells();
    for (const vec3& p : g.points()) points.push_back(p + vec3(3, 0, 0));
    for (const auto& t : g.cells()) cells.push_back({t[0] + 9, t[1] + 9, t[2] + 9});
    return {std::move(points), std::move(cells)};
}

// ---- Volumes
// ---------------------------------------------------------------------------------------------------------

/// The unit cube, n by n by n cubes of six positive tetrahedra each (Kuhn's subdivision: conforming).
inline mesh<tetrahedron> cube(int n)
{
    std::vector<vec3> points;
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) points.emplace_back(double(i) / n, double(j) / n, double(k) / n);
    const auto at = [=](int i, int j, int k) { return taut::idx((k * (n + 1) + j) * (n + 1) + i); };
    std::vector<std::array<taut::idx, 4>> cells;
    // A path along the axes in each of the six orders, from the lowest corner to the highest.
    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                for (int o = 0; o < 6; ++o)
                {
                    std::array<int, 3> p = {i, j, k};
                    std::array<taut::idx, 4> t{at(i, j, k)};
                    for (int s = 0; s < 3; ++s)
                    {
                        ++p[std::size_t(orders[o][s])];
                        t[std::size_t(s) + 1] = at(p[0], p[1], p[2]);
                    }
                    if (o >= 3) std::swap(t[1], t[2]); // odd orders are mirrored
                    cells.push_back(t);
                }
    return {std::move(points), std::move(cells)};
}

/// The same with vertices moved at random along the faces, edges and the inside that they are on: irregular tetrahedra,
/// all of them positive.
inline mesh<tetrahedron> jittered_cube(int n, unsigned seed)
{
    const auto m = cube(n);
    auto points = m.points();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-0.2 / n, 0.2 / n);
    for (vec3& p : points)
        for (int k = 0; k < 3; ++k)
            if (p[k] > 0 && p[k] < 1) p[k] += move(random);
    return {std::move(points), m.cells()};
}

inline mesh<tetrahedron> single_tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}, {0.3, 0.2, 0.8}}, {{0, 1, 2, 3}}};
}

} // namespace taut::test
