// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <span>

#include <taut/errors.hpp>
#include <taut/impl/charts/paste/rbf_error.hpp>
#include <taut/impl/charts/paste/rbf_field.hpp>

namespace taut::impl
{

class rbf_system;

/// Parameters of an rbf interpolation.
struct rbf_params
{
    rbf_basis basis = rbf_basis::cubic;
    double radius = 0; ///< support radius of Wendland's functions, in the units of the points; 0: half of their extent
    idx sparse_above = 1000; ///< points from which on Wendland's functions get a sparse factorisation

    /// Throws parameter_error that names the field.
    void validate() const
    {
        impl::rbf_value(basis, 0, 1);
        if (!(radius >= 0) || !std::isfinite(radius)) throw parameter_error("radius", "must be 0 or a positive number");
        if (sparse_above < 1) throw parameter_error("sparse_above", "must be positive");
    }
};

/// Radial basis function interpolation at points in space, factored once: solve() takes values and costs a
/// back-substitution. Coincident points are merged. The polynomial is that on the affine hull of the points, so that
/// planar or collinear points are allowed. Dense LU with pivots of the symmetric system
///
///     | Phi  P | | w |   | values |
///     | P^T  0 | | c | = | 0      |      (paper, eq. 27, with P the polynomial at the points)
///
/// or, of Wendland's functions, which are positive definite, sparse Cholesky.
class rbf
{
public:
    /// Throws parameter_error (no point, not finite), rbf_error where the system is singular in double precision.
    explicit rbf(std::span<const vec3> points, const rbf_params& params = {});

    /// Computes the field with values[i] at point i. Throws parameter_error for another number of values or one that is
    /// not finite, rbf_error where coincident points get different values.
    impl::rbf_field solve(std::span<const vec3> values) const;

    idx size() const;                    ///< points but for duplicates
    idx duplicates() const;              ///< that were merged
    int polynomial_terms() const;        ///< 0 to 4
    double reciprocal_condition() const; ///< an estimate in the 1-norm; NaN of a sparse one
    bool is_sparse() const;

private:
    std::shared_ptr<const impl::rbf_system> system_;
};

} // namespace taut::impl
