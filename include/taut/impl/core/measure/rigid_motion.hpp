// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <taut/rigid_motion.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Fits the rigid motion that takes points to their images in the sense of least squares. For collinear points, which
/// leave the rotation about their line open, it is the one of smallest angle. Both have one length, at least 1.
inline rigid_motion<2> fit_rigid_motion(std::span<const vec2> points, std::span<const vec2> images)
{
    rigid_motion<2> m;
    const auto n = static_cast<double>(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) m.from += points[i] / n, m.to += images[i] / n;
    double along = 0, across = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const vec2 p = points[i] - m.from, q = images[i] - m.to;
        along += glm::dot(p, q);
        across += p.x * q.y - p.y * q.x;
    }
    m.angle = std::atan2(across, along);
    return m;
}

/// Fits a rigid motion of space after Horn, "Closed-form solution of absolute orientation using unit quaternions"
/// (1987): the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix, found by repeated squaring.
inline rigid_motion<3> fit_rigid_motion(std::span<const vec3> points, std::span<const vec3> images)
{
    rigid_motion<3> m;
    const auto n = static_cast<double>(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) m.from += points[i] / n, m.to += images[i] / n;
    glm::dmat3 S(0.0); // S[j][i] = sum of p_i q_j
    for (std::size_t i = 0; i < points.size(); ++i) S += glm::outerProduct(points[i] - m.from, images[i] - m.to);
    glm::dmat4 N(0.0); // of quaternions (w, x, y, z)
    N[0] = {S[0][0] + S[1][1] + S[2][2], S[2][1] - S[1][2], S[0][2] - S[2][0], S[1][0] - S[0][1]};
    N[1] = {N[0][1], S[0][0] - S[1][1] - S[2][2], S[1][0] + S[0][1], S[0][2] + S[2][0]};
    N[2] = {N[0][2], N[1][2], S[1][1] - S[0][0] - S[2][2], S[2][1] + S[1][2]};
    N[3] = {N[0][3], N[1][3], N[2][3], S[2][2] - S[0][0] - S[1][1]};
    const auto size = [](const glm::dmat4& a)
    {
        double largest = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) largest = std::max(largest, std::abs(a[i][j]));
        return largest;
    };
    double scale = size(N);
    if (!(scale > 0)) return m;
    for (int i = 0; i < 4; ++i) N[i][i] += 4 * scale; // no eigenvalue is negative
    // So often that eigenvalues that are equal but for roundings stay so.
    for (int step = 0; step < 30; ++step)
    {
        N *= 1 / size(N);
        N = N * N;
    }
    // The projection on the eigenvectors of that eigenvalue; its first column is that of no turn, unless all of them
    // turn by pi.
    constexpr double least = 1e-8;
    int column = 0;
    if (!(N[0][0] > least * size(N)))
        for (int j = 1; j < 4; ++j)
            if (N[j][j] > N[column][column]) column = j;
    glm::dvec4 q = glm::normalize(N[column]);
    if (q[0] < 0) q = -q;
    const vec3 axis(q[1], q[2], q[3]);
    const double length = glm::length(axis);
    if (!(length > 0)) return m;
    m.axis = axis / length;
    m.angle = 2 * std::atan2(length, q[0]);
    return m;
}

} // namespace taut::impl
