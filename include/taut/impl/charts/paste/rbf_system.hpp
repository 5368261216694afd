// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <taut/impl/charts/paste/attach/near_pairs.hpp>
#include <taut/impl/charts/paste/rbf.hpp>
#include <taut/impl/charts/paste/rbf_error.hpp>

namespace taut::impl
{

/// The factored system of an interpolation; see taut::rbf.
class rbf_system
{
public:
    using matrix = Eigen::MatrixXd;

    /// Throws parameter_error (no point, not finite), rbf_error where the system is singular in double precision.
    explicit rbf_system(std::span<const vec3> points, const rbf_params& params = {}) : params_(params)
    {
        params.validate();
        if (points.empty()) throw parameter_error("points", "there must be one at least");
        normalise(points);
        merge(points);
        if (is_compact(params.basis) && size() > params.sparse_above)
            factor_sparse();
        else
            factor_dense();
    }

    /// The field that has values[i] at point i. Throws parameter_error for another number of values or one that is not
    /// finite, rbf_error where points in one place get different values.
    rbf_field solve(std::span<const vec3> values) const
    {
        if (values.size() != merged_to_.size())
            throw parameter_error("values", std::to_string(values.size()) + " for " +
                                                std::to_string(merged_to_.size()) + " points; give one per point");
        const Eigen::Index n = size(), terms = polynomial_.cols();
        matrix right = matrix::Zero(n + terms, 3);
        std::vector<idx> first(field_.centres.size(), -1), torn;
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            const auto to = static_cast<std::size_t>(merged_to_[i]);
            const Eigen::RowVector3d value(values[i].x, values[i].y, values[i].z);
            if (!value.allFinite())
                throw parameter_error("values", "that of point " + std::to_string(i) + " is not finite");
            if (first[to] < 0)
                right.row(merged_to_[i]) = value;
            else if (right.row(merged_to_[i]) != value)
                torn.insert(torn.end(), {first[to], static_cast<idx>(i)});
            first[to] = static_cast<idx>(i);
        }
        if (!torn.empty())
            throw rbf_error(torn, "points in one place have different values: ", "; give them one value");

        const matrix solution = sparse_ ? matrix(sparse_->solve(right)) : matrix(dense_->solve(right));
        rbf_field field = field_;
        const auto row = [&](Eigen::Index i) { return vec3(solution(i, 0), solution(i, 1), solution(i, 2)); };
        for (Eigen::Index i = 0; i < n; ++i) field.weights[static_cast<std::size_t>(i)] = row(i);
        if (terms == 0) return field;
        // From coordinates along the axes of the hull to x, y and z.
        field.polynomial[0] = row(n);
        for (Eigen::Index t = 1; t < terms; ++t)
            for (int k = 0; k < 3; ++k)
                field.polynomial[static_cast<std::size_t>(k) + 1] += axes_(k, t - 1) * row(n + t);
        return field;
    }

    idx size() const { return static_cast<idx>(field_.centres.size()); }            ///< points but for duplicates
    idx duplicates() const { return static_cast<idx>(merged_to_.size()) - size(); } ///< that were merged
    int polynomial_terms() const { return static_cast<int>(polynomial_.cols()); }   ///< 0 to 4
    double reciprocal_condition() const { return rcond_; } ///< an estimate in the 1-norm; NaN of a sparse one
    bool is_sparse() const { return sparse_ != nullptr; }

private:
    void normalise(std::span<const vec3> points)
    {
        vec3 low(std::numeric_limits<double>::infinity()), high = -low;
        for (std::size_t i = 0; i < points.size(); ++i)
        {
            if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z))
                throw parameter_error("points", "point " + std::to_string(i) + " is not finite");
            low = glm::min(low, points[i]);
            high = glm::max(high, points[i]);
        }
        field_.basis = params_.basis;
        field_.origin = 0.5 * (low + high);
        const double extent = glm::length(high - low);
        field_.unit = extent > 0 ? extent : 1;
        field_.radius = params_.radius > 0 ? params_.radius / field_.unit : 0.5;
    }

    /// Points within rounding of each other are one.
    void merge(std::span<const vec3> points)
    {
        std::vector<vec3> y;
        for (const vec3& p : points) y.push_back((p - field_.origin) / field_.unit);
        std::vector<idx> leader(y.size());
        std::iota(leader.begin(), leader.end(), 0);
        for_each_near_pair(y, 1e-12,
                           [&](std::size_t i, std::size_t j, double) // i < j
                           { leader[j] = std::min(leader[j], leader[i]); });
        for (std::size_t i = 0; i < y.size(); ++i)
        {
            if (leader[i] == static_cast<idx>(i))
            {
                merged_to_.push_back(size());
                of_centre_.push_back(static_cast<idx>(i));
                field_.centres.push_back(y[i]);
            }
            else
                merged_to_.push_back(merged_to_[static_cast<std::size_t>(leader[i])]);
        }
        field_.weights.assign(field_.centres.size(), vec3(0.0));
    }

    /// Columns 1, and coordinates along the axes of the affine hull of the points.
    void make_polynomial()
    {
        const int degree = polynomial_degree(params_.basis);
        const auto n = static_cast<Eigen::Index>(size());
        if (degree < 0) return polynomial_.resize(n, 0);
        matrix y(n, 3);
        for (Eigen::Index i = 0; i < n; ++i)
            for (int k = 0; k < 3; ++k) y(i, k) = field_.centres[static_cast<std::size_t>(i)][k];
        axes_.resize(3, 0);
        if (degree == 1)
        {
            const Eigen::RowVector3d mean = y.colwise().mean();
            const matrix from_mean = y.rowwise() - mean;
            const Eigen::Matrix3d moments = from_mean.transpose() * from_mean;
            const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments);
            int rank = 0; // moments are squares of lengths
            while (rank < 3 && eigen.eigenvalues()(2 - rank) > 1e-16 * std::max(1e-30, eigen.eigenvalues()(2))) ++rank;
            axes_ = eigen.eigenvectors().rightCols(rank);
        }
        polynomial_.resize(n, 1 + axes_.cols());
        polynomial_ << Eigen::VectorXd::Ones(n), y * axes_;
    }

    double phi(std::size_t i, std::size_t j) const
    {
        return rbf_value(params_.basis, glm::distance(field_.centres[i], field_.centres[j]), field_.radius);
    }

    void factor_dense()
    {
        make_polynomial();
        const Eigen::Index n = size(), terms = polynomial_.cols();
        matrix system = matrix::Zero(n + terms, n + terms);
        for (Eigen::Index j = 0; j < n; ++j)
            for (Eigen::Index i = 0; i < n; ++i)
                system(i, j) = phi(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        system.topRightCorner(n, terms) = polynomial_;
        system.bottomLeftCorner(terms, n) = polynomial_.transpose();
        dense_ = std::make_shared<const Eigen::PartialPivLU<matrix>>(system);
        rcond_ = dense_->rcond();
        if (!(rcond_ > 1e-16)) refuse();
    }

    void factor_sparse()
    {
        polynomial_.resize(size(), 0);
        std::vector<Eigen::Triplet<double>> entries;
        for (int i = 0; i < size(); ++i) entries.emplace_back(i, i, rbf_value(params_.basis, 0, field_.radius));
        for_each_near_pair(field_.centres, field_.radius,
                           [&](std::size_t i, std::size_t j, double r)
                           {
                               const double value = rbf_value(params_.basis, r, field_.radius);
                               entries.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
                           });
        Eigen::SparseMatrix<double> system(size(), size());
        system.setFromTriplets(entries.begin(), entries.end());
        sparse_ = std::make_shared<const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>>(system);
        if (sparse_->info() != Eigen::Success) refuse();
    }

    /// Names the points that are nearest to each other, which make two rows alike.
    [[noreturn]] void refuse() const
    {
        double nearest = 4; // of lengths up to 1
        std::vector<idx> pair;
        for (std::size_t i = 0; i < field_.centres.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (const double r = glm::distance(field_.centres[i], field_.centres[j]); r < nearest)
                {
                    nearest = r;
                    pair = {of_centre_[j], of_centre_[i]};
                }
        throw rbf_error(pair, "the interpolation is singular in double precision; the nearest points are ",
                        "; merge points that are near to each other, or take a smaller radius");
    }

    rbf_params params_;
    rbf_field field_;            ///< without weights
    std::vector<idx> merged_to_; ///< the centre of each point
    std::vector<idx> of_centre_; ///< the first point of each centre
    matrix axes_, polynomial_;
    std::shared_ptr<const Eigen::PartialPivLU<matrix>> dense_;
    std::shared_ptr<const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>> sparse_;
    double rcond_ = std::numeric_limits<double>::quiet_NaN();
};

} // namespace taut::impl
