// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/impl/core/objective/real_types.hpp>
#include <taut/recording.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

/// Common inputs of the element kernels, by the names under which it is bound (element_arrays::with).
struct element_inputs
{
    /// energy: determines the data of cells and the parameters.
    element_inputs(recording& r, const real_types& types, const any_energy& energy);

    recording::in_array<idx> corners;
    recording::in_array<double> inverse, measure, weight, x;
    sym<idx> cell_stride, vertex_stride;
    int attribute_count;
    std::optional<recording::in_array<double>> attributes, frames;
    std::vector<sym<double>> parameters;
};

/// Element of a kernel being traced: the loads of its work-item, and S computed from them. S is formed in the type of
/// positions and only then cast to that of the formula: in a thin element it is a small difference of long edges, and
/// its rounding would be the noise of the gradient (docs/explanation/numerics.md).
template <int D>
class traced_element
{
public:
    using real = sym<double>;
    using matrix = glm::mat<D, D, real>;

    /// formula: the type of S and of what is computed from it.
    traced_element(const element_inputs& in, sym<idx> cell, scalar_type position, scalar_type formula);

    real measure() const { return cast(formula_, in_.measure[cell_]); }
    real weight() const { return cast(formula_, in_.weight[cell_]); }

    /// Edges from corner 0 to corners 1..D, as columns, of an array of coordinates, in the type of positions.
    matrix edges(const recording::in_array<double>& x) const;

    /// Entry (row, column) of W^-1 for row <= column; the others are 0.
    const real& inverse(int row, int column) const
    {
        return inverse_[static_cast<std::size_t>(column * (column + 1) / 2 + row)];
    }

    /// S = A W^-1 (eq. 3) in the type of A, without the products by the zeros of W^-1.
    matrix shape_matrix(const matrix& A) const;
    /// Shape matrix of the map itself.
    matrix shape_matrix() const { return shape_matrix(edges(in_.x)); }

    /// Energy at S, in the frame of the ideal element.
    real density(const any_energy& energy, const matrix& S) const;

    /// Second derivatives of the density with respect to the entries of S, as provided by the energy
    /// (any_energy::hessian).
    auto own_hessian(const any_energy& energy, const matrix& S, const eigenvalue_filter<real>& filter) const
    {
        using found = decltype(energy.hessian(std::declval<element<real, D>>(), filter, formula_));
        if (in_.frames) return found();
        return energy.hessian(element<real, D>{S, glm::determinant(S), measure(), attributes_, parameters_}, filter,
                              formula_);
    }

    /// weight * density; +infinity where a barrier energy is outside its domain.
    real weighted(const any_energy& energy, const matrix& S, const real& weight) const;
    real weighted(const any_energy& energy, const matrix& S) const { return weighted(energy, S, weight()); }

    /// Gradient of weight * energy at S = A W^-1 with respect to the corners, corner 0 first; D entries per corner. An
    /// energy of S does not change under translation, so corner 0 takes minus the sum of the others.
    std::array<std::array<real, D>, D + 1> corner_gradients(const any_energy& energy, const matrix& S) const;

private:
    element_inputs in_;
    sym<idx> cell_;
    scalar_type position_, formula_;
    std::array<real, D*(D + 1) / 2> inverse_;
    std::vector<real> attributes_, parameters_;
};

template <int D>
traced_element<D>::traced_element(const element_inputs& in, sym<idx> cell, scalar_type position, scalar_type formula)
    : in_(in), cell_(cell), position_(position), formula_(formula)
{
    for (std::size_t k = 0; k < inverse_.size(); ++k)
        inverse_[k] = cast(formula, in.inverse[cell + static_cast<int>(k) * in.cell_stride]);
    for (int k = 0; k < in.attribute_count; ++k)
        attributes_.push_back(cast(formula, (*in.attributes)[cell + k * in.cell_stride]));
    for (const real& p : in.parameters) parameters_.push_back(cast(formula, p));
}

template <int D>
auto traced_element<D>::edges(const recording::in_array<double>& x) const -> matrix
{
    const sym<idx> first = in_.corners[cell_];
    matrix A;
    for (int k = 0; k < D; ++k)
    {
        const sym<idx> vertex = in_.corners[cell_ + (k + 1) * in_.cell_stride];
        for (int r = 0; r < D; ++r)
            A[k][r] =
                cast(position_, x[vertex + r * in_.vertex_stride]) - cast(position_, x[first + r * in_.vertex_stride]);
    }
    return A;
}

template <int D>
auto traced_element<D>::shape_matrix(const matrix& A) const -> matrix
{
    matrix S;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r)
        {
            real sum = A[0][r] * cast(position_, inverse(0, c));
            for (int k = 1; k <= c; ++k) sum = sum + A[k][r] * cast(position_, inverse(k, c));
            S[c][r] = cast(formula_, sum);
        }
    return S;
}

template <int D>
auto traced_element<D>::density(const any_energy& energy, const matrix& S) const -> real
{
    matrix seen = S;
    if (in_.frames)
    {
        matrix axes;
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r)
                axes[c][r] = cast(formula_, (*in_.frames)[cell_ + (c * D + r) * in_.cell_stride]);
        seen = S * axes;
    }
    return energy(element<real, D>{seen, glm::determinant(S), measure(), attributes_, parameters_});
}

template <int D>
auto traced_element<D>::weighted(const any_energy& energy, const matrix& S, const real& weight) const -> real
{
    const real det = glm::determinant(S);
    const real value = weight * density(energy, S);
    if (!energy.barrier()) return value;
    return select(det > 0.0, value, std::numeric_limits<double>::infinity());
}

template <int D>
auto traced_element<D>::corner_gradients(const any_energy& energy, const matrix& S) const
    -> std::array<std::array<real, D>, D + 1>
{
    const real value = weight() * density(energy, S);
    std::vector<real> entries;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) entries.push_back(S[c][r]);
    const auto by_entry = differentiate(value, entries);

    std::array<std::array<real, D>, D + 1> g;
    for (std::size_t r = 0; r < D; ++r)
    {
        real all = 0.0;
        for (std::size_t k = 0; k < D; ++k)
        {
            // Edge k takes part in columns k and on of S.
            real sum = by_entry[k * D + r] * inverse(int(k), int(k));
            for (std::size_t c = k + 1; c < D; ++c) sum = sum + by_entry[c * D + r] * inverse(int(k), int(c));
            g[k + 1][r] = sum;
            all = k == 0 ? sum : all + sum;
        }
        g[0][r] = -all;
    }
    return g;
}

// Compiled once, with the bodies.
extern template class traced_element<2>;

} // namespace taut::impl
