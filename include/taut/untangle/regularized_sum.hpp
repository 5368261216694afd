// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <taut/core/held_marks.hpp>
#include <taut/core/linalg.hpp>
#include <taut/core/parallel.hpp>
#include <taut/energy/regularized_triangle.hpp>
#include <taut/mesh/incidence.hpp>
#include <taut/start/target_shapes.hpp>

namespace taut::detail
{

/// The regularised energy of regularized_triangle.hpp over a mesh of any dimension, with its gradient:
///
///     sum of weight (|S|^2 / chi^(2/D) + area_weight (det S^2 + 1) / chi)
template <class Element>
class regularized_sum
{
public:
    static constexpr int D = Element::dimension;

    /// Both are referred to.
    regularized_sum(const mesh<Element>& m, const held_marks<D>& held)
        : mesh_(m),
          held_(held),
          around_(vertex_corners(m)),
          forces_(m.cells().size() * Element::corners),
          values_(m.cells().size())
    {
    }

    double eps = 1;
    double area_weight = 1;
    std::vector<target_shape<D>> shapes; ///< one an element

    /// x, gradient: D numbers a vertex; the gradient is 0 where a coordinate is held.
    double value_gradient(std::span<const double> x, std::span<double> gradient)
    {
        parallel_for(
            values_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t c = begin; c < end; ++c) element(x, c);
            },
            0, 1024);
        double sum = 0;
        for (const double v : values_) sum += v;
        for (idx v = 0; v < mesh_.vertex_count(); ++v)
        {
            vec<D> total(0.0);
            for (const idx corner : around_.row(v)) total += forces_[u(corner)];
            for (int k = 0; k < D; ++k)
                gradient[D * u(v) + static_cast<std::size_t>(k)] = held_.test(u(v), k) ? 0.0 : total[k];
        }
        return sum;
    }

    /// Smallest det S.
    double least_det(std::span<const double> x) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < values_.size(); ++c) least = std::min(least, glm::determinant(mapped(x, c)));
        return least;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    mat<D> mapped(std::span<const double> x, std::size_t c) const
    {
        const auto& t = mesh_.cells()[c];
        mat<D> A;
        for (int e = 0; e < D; ++e)
            for (int k = 0; k < D; ++k)
                A[e][k] = x[D * u(t[static_cast<std::size_t>(e) + 1]) + static_cast<std::size_t>(k)] -
                          x[D * u(t[0]) + static_cast<std::size_t>(k)];
        return A * shapes[c].inverse;
    }

    /// d det S / dS.
    static mat2 cofactors(const mat2& S) { return mat2(S[1][1], -S[1][0], -S[0][1], S[0][0]); }
    static mat3 cofactors(const mat3& S)
    {
        return mat3(glm::cross(S[1], S[2]), glm::cross(S[2], S[0]), glm::cross(S[0], S[1]));
    }

    void element(std::span<const double> x, std::size_t c)
    {
        const mat<D> S = mapped(x, c);
        const double det = glm::determinant(S), n2 = norm2(S), r = std::hypot(eps, det);
        const double chi = regularized_triangle::chi(eps, det); // d chi / d det = chi / r
        const double shape = D == 2 ? 1 / chi : 1 / std::cbrt(chi * chi), weight = shapes[c].weight;
        values_[c] = weight * (n2 * shape + area_weight * (det * det + 1) / chi);
        const double by_det = -2.0 / D * n2 * shape / r + area_weight * (2 * det - (det * det + 1) / r) / chi;
        const mat<D> by_edges = weight * (2 * shape * S + by_det * cofactors(S)) * glm::transpose(shapes[c].inverse);
        vec<D> first(0.0);
        for (int e = 0; e < D; ++e)
        {
            forces_[c * Element::corners + static_cast<std::size_t>(e) + 1] = by_edges[e];
            first -= by_edges[e];
        }
        forces_[c * Element::corners] = first;
    }

    const mesh<Element>& mesh_;
    const held_marks<D>& held_;
    csr around_;
    std::vector<vec<D>> forces_; // of a corner
    std::vector<double> values_; // of an element
};

} // namespace taut::detail
