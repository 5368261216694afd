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

#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/energy/corner_derivatives.hpp>
#include <taut/impl/core/energy/regularized.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/untangle/target_shapes.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// energy::regularized summed over a mesh by weight, with its gradient.
template <class Element>
class regularized_sum
{
public:
    static constexpr int D = Element::dimension;

    /// Both are referred to.
    regularized_sum(const mesh<Element>& m, const fixed_marks<D>& held)
        : mesh_(m),
          held_(held),
          around_(vertex_corners(m)),
          forces_(m.cells().size() * Element::corners),
          values_(m.cells().size())
    {
    }

    double eps = 1;
    double area_weight = 1;
    std::vector<target_shape<D>> shapes; ///< one per element

    /// x, gradient: D numbers per vertex; the gradient is 0 where a coordinate is fixed.
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
        const auto at = [&](int corner, int k)
        { return x[D * u(t[static_cast<std::size_t>(corner)]) + static_cast<std::size_t>(k)]; };
        mat<D> A;
        for (int e = 0; e < D; ++e)
            for (int k = 0; k < D; ++k) A[e][k] = at(e + 1, k) - at(0, k);
        return shape_matrix(A, shapes[c].inverse);
    }

    void element(std::span<const double> x, std::size_t c)
    {
        const mat<D> S = mapped(x, c);
        const double weight = shapes[c].weight;
        const auto f = energy::impl::regularized<D>{eps, area_weight}.first_derivatives(norm2(S), glm::determinant(S));
        values_[c] = weight * f.value;
        const auto g = corner_gradient<D>(weight * gradient_by_shape(S, f.by_I, f.by_d), shapes[c].inverse);
        for (std::size_t k = 0; k < g.size(); ++k) forces_[c * g.size() + k] = g[k];
    }

    const mesh<Element>& mesh_;
    const fixed_marks<D>& held_;
    csr around_;
    std::vector<vec<D>> forces_; // of a corner
    std::vector<double> values_; // of an element
};

} // namespace taut::impl
