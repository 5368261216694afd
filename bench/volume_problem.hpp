// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/mesh.hpp>
#include <taut/rigid_motion.hpp>

namespace bench
{

/// A volume whose ends along its longest axis are held: the low one stays, the high one is moved.
struct volume_problem
{
    using vec3 = taut::vec3;

    std::string name;
    taut::mesh<taut::tetrahedron> mesh;
    std::vector<taut::idx> low = {}, high = {};
    int axis = 2;
    double length = 0; ///< along the axis
    vec3 middle{0.0};  ///< of the high end

    /// share: of the length that belongs to each end; 0: what lies in the very first and last plane.
    volume_problem(std::string called, taut::mesh<taut::tetrahedron> volume, double share)
        : name(std::move(called)), mesh(std::move(volume))
    {
        vec3 least = mesh.points().front(), most = least;
        for (const vec3& p : mesh.points()) least = glm::min(least, p), most = glm::max(most, p);
        const vec3 size = most - least;
        for (int k = 0; k < 3; ++k)
            if (size[k] > size[axis]) axis = k;
        length = size[axis];
        for (taut::idx v = 0; v < mesh.vertex_count(); ++v)
        {
            const vec3& p = mesh.points()[static_cast<std::size_t>(v)];
            const double at = (p[axis] - least[axis]) / length;
            if (at <= share) low.push_back(v);
            if (at < 1 - share) continue;
            high.push_back(v);
            middle += p;
        }
        middle /= double(high.size());
    }

    /// Where the motions "twist" (by 90 degrees about the axis), "stretch" (by half the length), "bend" (by 90 degrees)
    /// bring a point of the high end.
    vec3 moved(const std::string& motion, const vec3& p) const
    {
        vec3 along(0.0), across(0.0);
        along[axis] = across[(axis + 2) % 3] = 1;
        if (motion == "stretch") return p + 0.5 * length * along;
        const bool twist = motion == "twist";
        const taut::rigid_motion<3> turn{.from = middle,
                                         .to = twist ? middle : middle + length * (0.5 * across - 0.3 * along),
                                         .axis = twist ? along : glm::cross(along, across),
                                         .angle = std::numbers::pi / 2};
        return turn(p);
    }

    taut::constraints<taut::tetrahedron> held(const std::string& motion) const
    {
        return taut::constraints<taut::tetrahedron>(mesh).fix(low).move(high, [&](const vec3& p)
                                                                        { return moved(motion, p); });
    }
};

/// A bar of nx by ny by nz cubes of six tetrahedra, 1 wide along x, its vertices jittered inside and along the sides.
inline volume_problem bar(int nx, int ny, int nz)
{
    std::vector<taut::vec3> points;
    std::vector<taut::mesh<taut::tetrahedron>::cell> cells;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> move(-0.2, 0.2);
    const auto at = [=](int i, int j, int k) { return static_cast<taut::idx>((k * (ny + 1) + j) * (nx + 1) + i); };
    for (int k = 0; k <= nz; ++k)
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i)
            {
                taut::vec3 p(i, j, k);
                const int last[] = {nx, ny, nz};
                for (int c = 0; c < 3; ++c)
                    if (p[c] > 0 && p[c] < last[c]) p[c] += move(random);
                points.push_back(p / double(nx));
            }
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
            {
                const taut::idx a = at(i, j, k), b = at(i + 1, j + 1, k + 1);
                const taut::idx ring[] = {at(i + 1, j, k),     at(i + 1, j + 1, k), at(i, j + 1, k),
                                          at(i, j + 1, k + 1), at(i, j, k + 1),     at(i + 1, j, k + 1)};
                for (int s = 0; s < 6; ++s) cells.push_back({a, ring[s], ring[(s + 1) % 6], b});
            }
    return {"bar", {std::move(points), std::move(cells)}, 0};
}

/// The bar of a name, "8x8x40", or "8" for that of 1 by 1 by 5; nothing where it is none.
inline std::optional<volume_problem> bar_of(const std::string& name)
{
    int n[3] = {}, end = 0;
    const int found = std::sscanf(name.c_str(), "%dx%dx%d%n", n, n + 1, n + 2, &end);
    if (found == 1 && name.find_first_not_of("0123456789") == std::string::npos) return bar(n[0], n[0], 5 * n[0]);
    if (found == 3 && end == int(name.size())) return bar(n[0], n[1], n[2]);
    return std::nullopt;
}

} // namespace bench
