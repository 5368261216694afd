// SPDX-License-Identifier: MIT
#pragma once

#include <taut/core/error.hpp>
#include <taut/solve/vector_space.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace taut::solve
{

/// How exactly a Newton system is solved.
struct pcg_params
{
    /// Products with the matrix, and with the preconditioner, at most. Range 1..16; rounded up to whole blocks.
    int max_steps = 8;

    /// Steps between two looks at the result; each look is a host wait. Range 1..4: beyond that the vectors of a block
    /// are too nearly parallel for float.
    int block = 2;

    /// Go on while the last block of steps, or the last step of the first block, brought more than this part of the
    /// model's decrease (Nash & Sofer 1990, "Assessing a search direction within a truncated-Newton method"). Range
    /// (0, 1). Lower it for more exact directions.
    double gain = 0.25;

    void validate() const
    {
        if (max_steps < 1 || max_steps > 16) throw parameter_error("pcg.max_steps", "must be in 1..16");
        if (block < 1 || block > 4) throw parameter_error("pcg.block", "must be in 1..4");
        if (!(gain > 0 && gain < 1)) throw parameter_error("pcg.gain", "must be in (0, 1)");
    }
};

/// What preconditioned conjugate gradients found.
struct pcg_result
{
    int steps = 0;               ///< dimension of the space that was searched, up to a direction of negative curvature
    double gradient_squared = 0; ///< |g|^2
    double slope = 0;            ///< g'd
    double decrease = 0;         ///< of the model g'd + d'A d / 2, at least 0
};

/// The minimiser d of the model g'd + d'A d / 2 over the Krylov space of M A and M g, which is what k steps of
/// preconditioned conjugate gradients from 0 reach (Nocedal & Wright, Algorithm 5.3). The s-step form (Chronopoulos &
/// Gear 1989): s vectors are made without any inner product, then all products come in one wait, and the small system
/// of the model is solved on the host.
///
/// | here       | meaning                                             |
/// |------------|-----------------------------------------------------|
/// | `p_, q_`   | basis of the Krylov space, A times it               |
/// | `K_, b_`   | p'A p and p'g                                       |
/// | `c`        | coefficients of d in the basis                      |
/// | `r_`       | the residual g + A d                                |
template <vector_space Space>
class pcg
{
public:
    using vector = typename Space::vector;

    pcg(Space& space, const pcg_params& params) : space_(space), params_(params), r_(space.make()) {}

    /// A(v, out) and M(v, out) are the products, M symmetric positive definite on the space of g.
    template <class Product, class Preconditioner>
    pcg_result solve(const vector& g, const Product& A, const Preconditioner& M, vector& d)
    {
        pcg_result result;
        std::vector<double> c;
        K_.clear();
        b_.clear();
        for (bool more = true; more && int(b_.size()) < params_.max_steps;)
        {
            const std::size_t before = b_.size();
            extend(g, A, M, c);
            if (before == 0) result.gradient_squared = gg_;
            // Step by step, so that the last one before a negative curvature counts.
            const double decrease_before = result.decrease;
            double last = 0;
            more = !broken_;
            for (std::size_t k = before + 1; k <= b_.size(); ++k)
            {
                auto longer = minimiser(k);
                more = more && !longer.empty();
                if (longer.empty()) break;
                double decrease = 0;
                for (std::size_t i = 0; i < k; ++i) decrease -= 0.5 * longer[i] * b_[i];
                last = decrease - result.decrease;
                result.decrease = decrease;
                c = std::move(longer);
            }
            if (before > 0) last = result.decrease - decrease_before;
            more = more && last > params_.gain * result.decrease;
        }
        // Without curvature to go by: steepest descent in the metric of M.
        if (c.empty()) c = {-1.0};
        result.steps = int(c.size());
        for (std::size_t i = 0; i < c.size(); ++i) result.slope += c[i] * b_[i];
        space_.linear_combination(c, pointers(p_, c.size()), d);
        return result;
    }

private:
    /// Appends a block to the basis, with its inner products: one wait.
    template <class Product, class Preconditioner>
    void extend(const vector& g, const Product& A, const Preconditioner& M, const std::vector<double>& c)
    {
        const std::size_t first = b_.size(), count = first + static_cast<std::size_t>(params_.block);
        while (p_.size() < count)
        {
            p_.push_back(space_.make());
            q_.push_back(space_.make());
        }
        if (first == 0)
            M(g, p_[0]);
        else
        {
            auto terms = pointers(q_, first);
            auto factors = c;
            factors.resize(first, 0.0);
            terms.push_back(&g);
            factors.push_back(1.0);
            space_.linear_combination(factors, terms, r_);
            M(r_, p_[first]);
        }
        for (std::size_t k = first; k < count; ++k)
        {
            if (k > first) M(q_[k - 1], p_[k]);
            A(p_[k], q_[k]);
        }

        std::vector<const vector*> left, right = pointers(q_, count);
        for (std::size_t k = first; k < count; ++k) left.push_back(&p_[k]);
        left.push_back(&g);
        right.push_back(&g);
        std::vector<double> products(left.size() * right.size());
        space_.multi_dot(left, right, products);
        broken_ = false;
        for (std::size_t k = first; k < count; ++k)
        {
            const double* row = products.data() + (k - first) * right.size();
            K_.emplace_back(row, row + k + 1);
            b_.push_back(row[count]);
            for (std::size_t i = 0; i <= count; ++i) broken_ = broken_ || !std::isfinite(row[i]);
        }
        gg_ = products.back();
    }

    /// The c with K c = -b for the first k basis vectors; empty if their K is not positive definite.
    std::vector<double> minimiser(std::size_t k) const
    {
        constexpr double least_pivot = 1e-6; // of a diagonal entry: below, in float, two vectors are one
        std::vector<std::vector<double>> L(k, std::vector<double>(k, 0.0));
        std::vector<double> c(k);
        for (std::size_t i = 0; i < k; ++i)
        {
            double sum = -b_[i];
            for (std::size_t j = 0; j <= i; ++j)
            {
                double s = K_[i][j];
                for (std::size_t m = 0; m < j; ++m) s -= L[i][m] * L[j][m];
                if (j < i)
                    sum -= (L[i][j] = s / L[j][j]) * c[j];
                else if (!(s > least_pivot * K_[i][i]) || !(K_[i][i] > 0))
                    return {};
                else
                    c[i] = sum / (L[i][i] = std::sqrt(s));
            }
        }
        for (std::size_t i = k; i-- > 0;)
        {
            for (std::size_t j = i + 1; j < k; ++j) c[i] -= L[j][i] * c[j];
            c[i] /= L[i][i];
        }
        return c;
    }

    static std::vector<const vector*> pointers(const std::vector<vector>& v, std::size_t n)
    {
        std::vector<const vector*> all;
        for (std::size_t i = 0; i < n; ++i) all.push_back(&v[i]);
        return all;
    }

    Space& space_;
    pcg_params params_;
    vector r_;
    std::vector<vector> p_, q_;
    std::vector<std::vector<double>> K_; // lower triangle
    std::vector<double> b_;
    double gg_ = 0;
    bool broken_ = false;
};

} // namespace taut::solve
