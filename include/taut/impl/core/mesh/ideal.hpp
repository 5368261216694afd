// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Cells flatter than this (smallest height / longest edge) have no ideal element. Double coordinates determine a
/// height to about 1e-16 of the edges: thinner ones are noise, anything thicker is a sliver that can be computed with.
inline constexpr double flattest = 1e-14;

/// The power of two that brings the largest coordinate of the mesh into [1, 2); 1 if all are 0. Multiplying by it is
/// exact, and squares and cubes of lengths then neither overflow nor vanish.
template <class Element>
double unit_scale(const mesh<Element>& m)
{
    double largest = 0;
    for (const vec3& p : m.points()) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // Beyond 2^1000 the reciprocal would be subnormal.
    return largest > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000)) : 1.0;
}

/// Mesh with all lengths multiplied by a factor, exactly, by its unit_scale.
template <class Element>
mesh<Element> scaled(const mesh<Element>& m, double factor)
{
    auto points = m.points();
    for (vec3& p : points) p *= factor;
    return {std::move(points), m.cells()};
}

/// Jacobian S = A W^-1 (eq. 3) of the map of an element, A the edges of the image from corner 0. inverse: W^-1, upper
/// triangular.
inline mat2 shape_matrix(const mat2& A, const mat2& inverse)
{
    return mat2(inverse[0][0] * A[0], inverse[1][0] * A[0] + inverse[1][1] * A[1]);
}

inline mat3 shape_matrix(const mat3& A, const mat3& inverse)
{
    return mat3(inverse[0][0] * A[0], inverse[1][0] * A[0] + inverse[1][1] * A[1],
                inverse[2][0] * A[0] + inverse[2][1] * A[1] + inverse[2][2] * A[2]);
}

/// Jacobian of a cell. x: one image point per vertex.
template <int D, std::size_t N>
mat<D> shape_matrix(const std::array<idx, N>& cell, std::span<const vec<D>> x, const mat<D>& inverse)
{
    const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(cell[k])]; };
    mat<D> A;
    for (int k = 0; k < D; ++k) A[k] = at(static_cast<std::size_t>(k) + 1) - at(0);
    return shape_matrix(A, inverse);
}

/// Inverse of an upper triangular matrix by back substitution: no determinant, which may underflow on slivers.
inline mat2 invert_upper(const mat2& W)
{
    const double x = 1 / W[0][0], y = 1 / W[1][1];
    return mat2(x, 0.0, -x * (W[1][0] * y), y);
}
inline mat3 invert_upper(const mat3& W)
{
    const double x = 1 / W[0][0], y = 1 / W[1][1], z = 1 / W[2][2];
    const double yz = -y * (W[2][1] * z), xy = -x * (W[1][0] * y);
    return mat3(x, 0.0, 0.0, xy, y, 0.0, -x * (W[1][0] * yz + W[2][0] * z), yz, z);
}

/// The ideal edge matrix of a triangle with edges a and b from corner 0. Flat triangles have none: a height near 0
/// makes them stiff instead.
inline mat2 stiff_ideal(const vec3& a, const vec3& b)
{
    const double along = std::max(glm::length(a), std::numeric_limits<double>::min());
    const double height = std::max(glm::length(glm::cross(a, b)) / along, 1e-6 * along);
    return mat2(along, 0.0, glm::dot(a, b) / along, height);
}

/// The corners of cell c of the mesh times `scale`.
template <class Element>
typename Element::rest_corners scaled_rest(const mesh<Element>& m, idx c, double scale)
{
    auto x = m.rest(c);
    for (vec3& p : x) p *= scale;
    return x;
}

/// W of cell c of the mesh times `scale`.
template <class Element>
mat<Element::dimension> ideal_of(const mesh<Element>& m, idx c, double scale)
{
    return Element::ideal(scaled_rest(m, c, scale));
}

/// Cells that are flat, and cells that are inverted, at rest.
template <class Element>
std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<Element>& m)
{
    const double unit = unit_scale(m);
    const auto flatness = [&](idx c) { return Element::flatness(ideal_of(m, c, unit)); };
    std::atomic<bool> any{false};
    parallel_for(m.cells().size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                         if (!Element::is_thick(scaled_rest(m, static_cast<idx>(c), unit)) &&
                             !(flatness(static_cast<idx>(c)) > flattest))
                             any = true;
                 });
    std::pair<std::vector<idx>, std::vector<idx>> bad;
    for (idx c = 0; any && c < m.cell_count(); ++c)
    {
        const double f = flatness(c);
        if (f < -flattest)
            bad.second.push_back(c);
        else if (!(f > flattest))
            bad.first.push_back(c);
    }
    return bad;
}

/// Ideal elements of all cells (paper, equations 1 to 10 and 18): congruent to the cell at rest, so that S = A W^-1 is
/// a rotation exactly where the map is an isometry, and det S is mapped / rest measure.
template <class Element>
struct ideal_elements
{
    static constexpr int D = Element::dimension;

    std::vector<mat<D>> inverse; ///< W^-1, upper triangular, one per cell; finite
    std::vector<double> measure; ///< rest area or volume, one per cell

    /// Any others, one per cell.
    ideal_elements(std::vector<mat<D>> inverses, std::vector<double> measures)
        : inverse(std::move(inverses)), measure(std::move(measures))
    {
    }

    /// Computes the ideal elements of the mesh times `scale`: W^-1 in 1 / length and measure in length^D of the scaled
    /// mesh.
    /// Throws mesh_error (degenerate_cell, inverted_cell) with every cell that has no ideal element.
    explicit ideal_elements(const mesh<Element>& m, double scale = 1.0);
};

template <class Element>
ideal_elements<Element>::ideal_elements(const mesh<Element>& m, double scale)
    : inverse(static_cast<std::size_t>(m.cell_count())), measure(inverse.size())
{
    const double unit = impl::unit_scale(m), f = scale / unit;
    const double measure_scale = Element::measure_factor * (D == 2 ? f * f : f * f * f);
    std::atomic<bool> bad{false};
    impl::parallel_for(inverse.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t c = begin; c < end; ++c)
                           {
                               const mat<D> W = impl::ideal_of(m, static_cast<idx>(c), unit);
                               if (!(Element::flatness(W) > impl::flattest)) bad = true;
                               double det = measure_scale;
                               for (int k = 0; k < D; ++k) det *= W[k][k];
                               inverse[c] = impl::invert_upper(W) / f;
                               measure[c] = det;
                           }
                       });
    if (!bad) return;
    auto [flat, inverted] = impl::bad_rest_cells(m);
    if (!flat.empty()) throw mesh_error(describe<Element>(mesh_error::degenerate_cell, std::move(flat)));
    if (!inverted.empty()) throw mesh_error(describe<Element>(mesh_error::inverted_cell, std::move(inverted)));
}

/// Elements with the edges from corner 0 that are the columns of matrices, times `scale`, one per cell.
/// Throws parameter_error of that name for the first that is flat or inverted.
template <class Element>
ideal_elements<Element> elements_with_edges(std::span<const mat<Element::dimension>> edges, double scale,
                                            const char* name)
{
    constexpr int D = Element::dimension;
    std::vector<mat<D>> inverse;
    std::vector<double> measure;
    for (const mat<D>& A : edges)
    {
        typename Element::rest_corners x{};
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < D; ++r) x[static_cast<std::size_t>(k) + 1][r] = scale * A[k][r];
        const mat<D> W = Element::ideal(x);
        if (!(Element::flatness(W) > flattest) || !(glm::determinant(A) > 0))
            throw parameter_error(name,
                                  "element " + std::to_string(inverse.size()) +
                                      " is flat or inverted; columns are edges from corner 0 to the others in turn");
        double det = Element::measure_factor;
        for (int k = 0; k < D; ++k) det *= W[k][k];
        inverse.push_back(impl::invert_upper(W));
        measure.push_back(det);
    }
    return {std::move(inverse), std::move(measure)};
}

/// Edge matrix of the regular triangle or tetrahedron of edge length 1, upper triangular.
template <class Element>
mat<Element::dimension> regular_ideal()
{
    mat<Element::dimension> W(1.0);
    W[1][0] = 0.5;
    W[1][1] = std::numbers::sqrt3 / 2;
    if constexpr (Element::dimension == 3)
    {
        W[2][0] = 0.5;
        W[2][1] = std::numbers::sqrt3 / 6;
        W[2][2] = std::numbers::sqrt2 / std::numbers::sqrt3;
    }
    return W;
}

/// Regular elements, all of the same size, that have a measure together.
template <class Element>
ideal_elements<Element> regular_elements(std::size_t count, double measure)
{
    constexpr int D = Element::dimension;
    const mat<D> W = regular_ideal<Element>();
    double one = Element::measure_factor;
    for (int k = 0; k < D; ++k) one *= W[k][k];
    const double each = measure / static_cast<double>(count), edge = std::pow(each / one, 1.0 / D);
    return {std::vector<mat<D>>(count, impl::invert_upper(W) / edge), std::vector<double>(count, each)};
}

// Compiled once, with the bodies.
extern template std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<triangle>&);
extern template std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<tetrahedron>&);
extern template struct ideal_elements<triangle>;
extern template struct ideal_elements<tetrahedron>;

} // namespace taut::impl
