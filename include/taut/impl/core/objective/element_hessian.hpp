// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/elements.hpp>
#include <taut/impl/core/compute/record.hpp>
#include <taut/impl/core/energy/eigenvalue_filter.hpp>
#include <taut/impl/core/energy/isotropic.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/impl/core/objective/traced_element.hpp>

namespace taut::impl
{

/// Storage of an element's Hessian: blocks of D x D for pairs of corners k <= l in the order (0,0) (0,1) .. (0,D) (1,1)
/// .. (D,D). A block on the diagonal has its upper triangle by rows (2D: xx xy yy), the others all entries by rows,
/// which belong to corner k (2D: xx xy yx yy). Slot n of cell c stands at [n * cell_stride + c].
template <int D>
struct hessian_slots
{
    static constexpr int diagonal = D * (D + 1) / 2; ///< entries of a block (k, k)
    static constexpr int count = (D + 1) * diagonal + D * (D + 1) / 2 * D * D;

    /// Slot of d2 E / d(coordinate i of corner k) d(coordinate j of corner l), in either order.
    static constexpr int at(int k, int i, int l, int j)
    {
        if (k > l || (k == l && i > j)) return at(l, j, k, i);
        int slot = 0;
        for (int row = 0; row < k; ++row) slot += diagonal + (D - row) * D * D;
        if (k == l) return slot + i * D - i * (i - 1) / 2 + (j - i);
        return slot + diagonal + (l - k - 1) * D * D + i * D + j;
    }
};

/// Kernels of the second derivatives of weight * energy by the corners of each element, one work-item per element;
/// arrays and ranges as in element_kernels. The domain is not tested: outside of a barrier's the result is undefined.
///
/// An energy with a Hessian of its own (any_energy::hessian) provides it; one of |S|^2 and det S takes the closed forms
/// of modes.hpp. Any other is differentiated twice on the tape and filtered by Jacobi rotations; in space its diagonal
/// is shifted instead, whatever the filter.
template <class Element>
struct element_hessian_kernel
{
    static constexpr int D = Element::dimension;
    using slots = hessian_slots<D>;

    /// element_inputs, as_argument(definiteness) -> "hessian", slots::count x cell_stride
    recorded_kernel launch;

    element_hessian_kernel(const queue& q, const any_energy& energy, const real_types& types)
        : element_hessian_kernel(traced_program(q, {record(energy, types, impl::form_for(q.device()))}))
    {
    }

    /// Takes the kernel from a program with the text of record().
    explicit element_hessian_kernel(const traced_program& p) : launch(p, name) {}

    /// Records all kinds of Hessian in one kernel: most of its code is common to them.
    static named_argument as_argument(definiteness sign) { return {"definiteness", static_cast<idx>(sign)}; }

    /// Text of the kernel, for a shared program.
    static kernel_text record(const any_energy& energy, const real_types& types, kernel_form form);

private:
    using traced = traced_element<D>;
    using real = typename traced::real;
    using matrix = typename traced::matrix;
    static constexpr int N = D * D;

    static constexpr const char* name = "element_hessian";

    /// Second derivatives of weight * energy with respect to the entries of S, by columns.
    static symmetric_matrix<real, N> by_shape_matrix(const any_energy& energy, const traced& e,
                                                     const eigenvalue_filter<real>& filter, scalar_type type);

    /// H + t I with the minimum t >= 0 for which Gershgorin's circles show it positive semi-definite. In space the
    /// rotations of filtered_matrix are 0.8 MB of unrolled code, which a driver compiles for half a minute.
    static symmetric_matrix<real, N> shifted(symmetric_matrix<real, N> H, sym_bool projected);

    /// Chain rule from the entries of S to the corners: S is linear in the edges A = S W, and an edge is a corner minus
    /// corner 0, which takes minus the sum of the others.
    static symmetric_matrix<real, D*(D + 1)> corner_hessian(const symmetric_matrix<real, N>& H, const traced& e);

    /// Minus the sum over corners 1..D of the entries (coordinate i of the corner, column).
    static real minus_sum(const symmetric_matrix<real, D*(D + 1)>& H, int i, int column)
    {
        real sum = H(D + i, column);
        for (int k = 2; k <= D; ++k) sum = sum + H(k * D + i, column);
        return -sum;
    }
};

template <class Element>
kernel_text element_hessian_kernel<Element>::record(const any_energy& energy, const real_types& types, kernel_form form)
{
    recording r(types.vector);
    const element_inputs in(r, types, energy);
    const auto sign = r.scalar<idx>("definiteness");
    const eigenvalue_filter<real> filter{.projected = sign != static_cast<idx>(definiteness::indefinite),
                                         .absolute = sign == static_cast<idx>(definiteness::absolute)};
    auto hessian = r.out<double>("hessian", types.vector);
    const auto cell = r.global_id();
    const traced e(in, cell, types.position, types.vector);
    const auto H = corner_hessian(by_shape_matrix(energy, e, filter, types.vector), e);
    for (int k = 0; k <= D; ++k)
        for (int l = k; l <= D; ++l)
            for (int i = 0; i < D; ++i)
                for (int j = k == l ? i : 0; j < D; ++j)
                    hessian[cell + slots::at(k, i, l, j) * in.cell_stride] = H(k * D + i, l * D + j);
    return r.finish(name, form);
}

template <class Element>
auto element_hessian_kernel<Element>::by_shape_matrix(const any_energy& energy, const traced& e,
                                                      const eigenvalue_filter<real>& filter, scalar_type type)
    -> symmetric_matrix<real, N>
{
    const matrix S = e.shape_matrix();
    const real weight = e.weight();
    if (auto own = e.own_hessian(energy, S, filter))
    {
        for (int j = 0; j < N; ++j)
            for (int i = 0; i <= j; ++i) (*own)(i, j) = weight * (*own)(i, j);
        return *own;
    }
    const real value = e.density(energy, S);
    const auto psi = derivatives_by_invariants<D>(value, S);
    if constexpr (D == 2)
    {
        if (psi) return plane_modes<real>(S, *psi, filter).hessian(weight);
    }
    else if (psi)
        return space_modes<real>(S, *psi, type, filter).hessian(weight);

    std::vector<real> entries;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) entries.push_back(S[c][r]);
    const auto gradient = differentiate(value, entries);
    symmetric_matrix<real, N> H;
    for (int j = 0; j < N; ++j)
    {
        const std::span<const real> upper(entries.data(), static_cast<std::size_t>(j) + 1);
        const auto row = differentiate(gradient[static_cast<std::size_t>(j)], upper);
        for (int i = 0; i <= j; ++i) H(i, j) = weight * row[static_cast<std::size_t>(i)];
    }
    if constexpr (D == 2)
        return filtered_matrix<real, N>::of(H, type, filter);
    else
        return shifted(std::move(H), filter.projected);
}

template <class Element>
auto element_hessian_kernel<Element>::shifted(symmetric_matrix<real, N> H, sym_bool projected)
    -> symmetric_matrix<real, N>
{
    real t = 0.0;
    for (int i = 0; i < N; ++i)
    {
        real radius = 0.0;
        for (int j = 0; j < N; ++j)
            if (j != i) radius = radius + abs(H(i, j));
        t = max(t, radius - H(i, i));
    }
    t = select(projected, t, real(0.0));
    for (int i = 0; i < N; ++i) H(i, i) = H(i, i) + t;
    return H;
}

template <class Element>
auto element_hessian_kernel<Element>::corner_hessian(const symmetric_matrix<real, N>& H, const traced& e)
    -> symmetric_matrix<real, D*(D + 1)>
{
    symmetric_matrix<real, D*(D + 1)> result;
    // Rows of edges, columns of entries of S: the product from the left. Row k of W^-1 begins at column k.
    const auto half = [&](int k, int i, int entry)
    {
        real sum = e.inverse(k, k) * H(k * D + i, entry);
        for (int c = k + 1; c < D; ++c) sum = sum + e.inverse(k, c) * H(c * D + i, entry);
        return sum;
    };
    for (int k = 0; k < D; ++k)
        for (int i = 0; i < D; ++i)
            for (int l = k; l < D; ++l)
                for (int j = k == l ? i : 0; j < D; ++j)
                {
                    real sum = half(k, i, l * D + j) * e.inverse(l, l);
                    for (int c = l + 1; c < D; ++c) sum = sum + half(k, i, c * D + j) * e.inverse(l, c);
                    result((k + 1) * D + i, (l + 1) * D + j) = sum;
                }
    for (int l = 1; l <= D; ++l)
        for (int i = 0; i < D; ++i)
            for (int j = 0; j < D; ++j) result(i, l * D + j) = minus_sum(result, i, l * D + j);
    for (int i = 0; i < D; ++i)
        for (int j = i; j < D; ++j) result(i, j) = minus_sum(result, j, i);
    return result;
}

// Compiled once, with the bodies.
extern template struct element_hessian_kernel<triangle>;

} // namespace taut::impl
