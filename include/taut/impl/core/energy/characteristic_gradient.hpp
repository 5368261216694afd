// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/impl/core/mesh/layout.hpp>

namespace taut::impl
{

/// Largest second difference of the energy at the identity along single entries of S and the dilation.
template <int D>
double largest_curvature(const any_energy& energy, double h)
{
    const auto at = [&](const mat<D>& S) { return energy(element<double, D>{S, glm::determinant(S), 1.0}); };
    double most = 0;
    const auto probe = [&](const mat<D>& direction)
    {
        const mat<D> I(1.0);
        const double second = (at(I + h * direction) - 2 * at(I) + at(I - h * direction)) / (h * h);
        most = std::max(most, second / norm2(direction));
    };
    probe(mat<D>(1.0));
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r)
        {
            mat<D> direction(0.0);
            direction[c][r] = 1;
            direction[r][c] = 1;
            probe(direction);
        }
    return most;
}

/// Approximate largest eigenvalue of the energy's Hessian at rest; 1 at a kink, where the quotient grows as 1/h, and
/// the energy has no stiffness.
template <int D>
double stiffness(const any_energy& energy)
{
    const double coarse = largest_curvature<D>(energy, 1e-3), fine = largest_curvature<D>(energy, 1e-4);
    return coarse > 0 && std::isfinite(fine) && fine < 2 * coarse ? fine : 1;
}

/// Norm of a gradient that is typical of the mesh: the same relative gradient then means the same on every mesh and
/// scale. It is 2 lambda |l|, where l_v = sum over cells at v of w_c |grad phi_v| and lambda is the largest eigenvalue
/// of the energy's Hessian at rest (8 for the isometric energy in the plane, which makes the factor 16). After Zhu,
/// Bridson, Kaufman 2018 ("Blended cured quasi-Newton"), section 4.
template <class Element>
double characteristic_gradient(const layout<Element>& mesh_layout, const any_energy& energy, energy::weighting weights)
{
    constexpr int D = Element::dimension;
    const auto stride = mesh_layout.cell_stride;
    const bool uniform = weights == energy::weighting::uniform;
    std::vector<double> l(static_cast<std::size_t>(mesh_layout.vertex_count), 0.0);
    double total = 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(mesh_layout.cell_count); ++c)
    {
        const auto at = [&](std::size_t k) -> double&
        { return l[static_cast<std::size_t>(mesh_layout.corners[k * stride + c])]; };
        double w = uniform ? 1 : mesh_layout.measure[c];
        if (!mesh_layout.weight.empty()) w *= mesh_layout.weight[c];
        total += w;
        // Rows of W^-1 are the gradients of the basis functions of corners 1..D; corner 0 has minus their sum.
        vec<D> sum(0.0);
        for (int k = 0; k < D; ++k)
        {
            vec<D> row(0.0);
            for (int column = k; column < D; ++column)
                row[column] = mesh_layout.inverse[static_cast<std::size_t>(column * (column + 1) / 2 + k) * stride + c];
            sum += row;
            at(static_cast<std::size_t>(k) + 1) += w * glm::length(row);
        }
        at(0) += w * glm::length(sum);
    }
    double squares = 0;
    for (const double v : l) squares += v * v;
    return 2 * impl::stiffness<D>(energy) * std::sqrt(squares) / total;
}

} // namespace taut::impl
