// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/manifold.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Wall-clock seconds of the parts of a paste.
struct paste_seconds
{
    double region = 0;    ///< the surroundings of the target vertex
    double map = 0;       ///< their parameterization
    double land = 0;      ///< correspondences of the rim
    double seam = 0;      ///< room and gap
    double factor = 0;    ///< factorisation of the radial basis functions
    double transform = 0; ///< the last change of pose: back-substitutions, kernels, coordinates
};

/// Report of a paste.
struct paste_report
{
    std::string way;           ///< projection of the rim to the target: projected, laid, smoothed or circle
    idx removed_triangles = 0; ///< triangles removed from the target
    idx gap_triangles = 0;     ///< between target and rim
    idx feature_triangles = 0;
    idx bent_vertices = 0;           ///< vertices of the target moved by the fields
    idx controls = 0;                ///< points of the field that bends the target
    double reciprocal_condition = 0; ///< reciprocal condition of its system
    impl::paste_seconds seconds;
};

/// Quality of a surface along the seam of a paste.
struct seam_quality
{
    idx boundary_edges = 0;    ///< boundary edges of the whole surface: 0 where it is watertight
    bool manifold = false;     ///< at edges and vertices, and neighbours oriented alike
    idx degenerate = 0;        ///< triangles of no area
    idx folded = 0;            ///< edges of gap and feature whose triangles turn back by more than 150 degrees
    double smallest_angle = 0; ///< minimum angle of the triangles of the gap, degrees
    double median_angle = 0;   ///< between the normals across the rim, degrees
    double largest_angle = 0;
};

inline double degrees_between(const vec3& a, const vec3& b)
{
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

constexpr double fold_angle = 150; ///< degrees from which on two triangles fold at their edge

/// The angle between the normals of two triangles, in degrees.
inline double turned_back(const mesh<triangle>& m, idx f, idx g)
{
    const auto normal = [&](idx t)
    {
        const auto x = m.rest(t);
        return glm::cross(x[1] - x[0], x[2] - x[0]);
    };
    return degrees_between(normal(f), normal(g));
}

/// Pairs of neighbours, the later one from `first` on, that turn back by more than an angle in degrees.
inline std::vector<std::array<idx, 2>> folded_edges(const mesh<triangle>& m, idx first, double angle)
{
    const auto sides = facets(m);
    std::vector<std::array<idx, 2>> pairs;
    for (idx s = 3 * first; s < 3 * m.cell_count(); ++s)
        if (const idx twin = sides.twin[static_cast<std::size_t>(s)];
            twin >= 0 && twin < s && turned_back(m, twin / 3, s / 3) > angle)
            pairs.push_back({twin / 3, s / 3});
    return pairs;
}

/// Measures the result of a paste: triangles from first_gap on are of the gap, from first_feature on of the feature.
inline seam_quality measure_seam(const mesh<triangle>& m, idx first_gap, idx first_feature)
{
    seam_quality q;
    const auto sides = facets(m);
    q.manifold = sides.oriented() && pinched_vertices(m, sides).empty();
    q.boundary_edges = static_cast<idx>(std::count(sides.twin.begin(), sides.twin.end(), facet_table::boundary));
    std::vector<vec3> normals;
    double smallest = 180;
    for (idx f = 0; f < m.cell_count(); ++f)
    {
        const auto x = m.rest(f);
        normals.push_back(glm::cross(x[1] - x[0], x[2] - x[0]));
        if (!(glm::length(normals.back()) > 0)) ++q.degenerate;
        if (f < first_gap || f >= first_feature) continue;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec3 a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
            smallest = std::min(smallest, degrees_between(a, b));
        }
    }
    q.smallest_angle = smallest;
    std::vector<double> angles;
    for (idx s = 3 * first_gap; s < 3 * m.cell_count(); ++s)
    {
        const idx twin = sides.twin[static_cast<std::size_t>(s)];
        if (twin < 0 || twin > s) continue; // an edge once, from the later side
        const vec3 &a = normals[static_cast<std::size_t>(s / 3)], &b = normals[static_cast<std::size_t>(twin / 3)];
        const double angle = degrees_between(a, b);
        if (angle > fold_angle) ++q.folded;
        if (s / 3 >= first_feature && twin / 3 >= first_gap && twin / 3 < first_feature) angles.push_back(angle);
    }
    if (angles.empty()) return q;
    std::sort(angles.begin(), angles.end());
    q.median_angle = angles[angles.size() / 2];
    q.largest_angle = angles.back();
    return q;
}

} // namespace taut::impl
