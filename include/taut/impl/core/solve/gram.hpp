// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/objective.hpp>
#include <taut/impl/core/solve/objective_bodies.hpp>
#include <taut/impl/core/solve/pair_memory.hpp>
#include <taut/solve_params.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace taut::solve::impl
{

/// The inverse Hessian H_k of L-BFGS by inner products: the two-loop recursion only ever forms linear combinations of
/// the vectors s_i, y_i and g, so it is run on their coefficients, with the Gram matrix of these vectors in place of
/// the vectors. Per iteration one `multi_dot` brings the products of the three new vectors with all others, and one
/// `linear_combination` makes the direction; the O(m^2) arithmetic between them is the host's, in double.
///
/// Source: Nocedal & Wright, Algorithm 7.4, in the "vector-free" arrangement of Chen, Wang & Zhou (NIPS 2014).
///
/// Host waits: 1 in `propose`, none in `accept`, `multiply`, `direction`. With a preconditioner H0 one more in each of
/// `accept` (gamma) and `multiply` (its product is a vector from outside the span).
///
/// | here                      | meaning                                                                          |
/// |---------------------------|----------------------------------------------------------------------------------|
/// | row 2 i, row 2 i + 1      | s and y of slot i                                                                |
/// | `row_g`, `row_new`        | the current gradient; the gradient of the trial pair                             |
/// | `row_r`                   | r = H0 q, with a preconditioner                                                  |
/// | `c_`                      | coefficients of q, then of r = H g                                               |
template <vector_space Space>
class gram_inverse_hessian
{
public:
    using vector = typename Space::vector;

    gram_inverse_hessian(Space& space, const memory_params& params, preconditioner<vector> h0 = {});

    gram_inverse_hessian(const gram_inverse_hessian&) = delete; // vectors_ points into itself
    gram_inverse_hessian& operator=(const gram_inverse_hessian&) = delete;

    /// The first gradient.
    void start(const vector& g) { gram(row_g(), row_g()) = space_.dot(g, g); }

    /// Drops all pairs; the next direction has about this length.
    void forget(double length);

    /// No pairs: the next direction is steepest descent.
    bool fresh() const noexcept { return memory_.empty(); }

    /// The pair of the last step was left out: the newest pair is older than that.
    bool skipped() const noexcept { return skipped_; }

    /// |g|^2 of the current gradient.
    double gradient_squared() const { return gram(row_g(), row_g()); }

    /// r = H g for the current gradient: coefficients only.
    void multiply(const vector& g);

    /// g'H g, after multiply.
    double g_h_g() const { return product(row_g()); }

    /// y'H g with the newest y, after multiply.
    double y_h_g() const { return product(2 * memory_.order().back() + 1); }

    /// Inner products of the newest pair.
    const pair_products& newest_products() const { return memory_[memory_.order().back()].products; }

    /// The step a of the newest pair, s = a d.
    double newest_step() const noexcept { return step_; }

    /// d = -H g + t s with the newest s, after multiply.
    direction_info direction(double t, vector& d);

    /// The trial pair s = a d, y = g_new - g and its products with everything kept; returns d'g_new.
    double propose(double a, const vector& d, const vector& g, const vector& g_new);

    /// The trial pair and its gradient become the newest; false where the pair is left out for its curvature.
    bool accept();

private:
    int row_g() const noexcept { return rows_ - 3; }
    int row_new() const noexcept { return rows_ - 2; }
    int row_r() const noexcept { return rows_ - 1; }

    double& gram(int i, int j) { return gram_[std::size_t(i) * std::size_t(rows_) + std::size_t(j)]; }
    double gram(int i, int j) const { return gram_[std::size_t(i) * std::size_t(rows_) + std::size_t(j)]; }
    double& c(int i) { return c_[std::size_t(i)]; }
    double c(int i) const { return c_[std::size_t(i)]; }

    /// The inner product of a row's vector with the combination c.
    double product(int row) const;

    /// All products of two sets of rows in one wait.
    void fetch(std::span<const int> left, std::span<const int> right);

    /// r = gamma H0 q as a vector, and its products.
    void apply_h0();

    double scale() const;

    Space& space_;
    pair_memory<Space> memory_;
    preconditioner<vector> h0_;
    int rows_;
    std::vector<double> gram_;           // rows_ x rows_, symmetric; entries of dropped vectors are stale
    std::vector<double> c_;              // a coefficient a row
    std::vector<const vector*> vectors_; // a vector per row; the gradients belong to the caller
    std::optional<vector> q_, r_;        // with a preconditioner only
    double length_ = 1, step_ = 1, proposed_step_ = 1;
    bool skipped_ = false;
};

template <vector_space Space>
gram_inverse_hessian<Space>::gram_inverse_hessian(Space& space, const memory_params& params, preconditioner<vector> h0)
    : space_(space),
      memory_(space, params),
      h0_(std::move(h0)),
      rows_(2 * memory_.slots() + 3),
      gram_(std::size_t(rows_) * std::size_t(rows_)),
      c_(std::size_t(rows_)),
      vectors_(std::size_t(rows_))
{
    for (int i = 0; i < memory_.slots(); ++i)
    {
        vectors_[std::size_t(2 * i)] = &memory_[i].s;
        vectors_[std::size_t(2 * i + 1)] = &memory_[i].y;
    }
    if (h0_)
    {
        q_.emplace(space.make());
        r_.emplace(space.make());
        vectors_[std::size_t(row_r())] = &*r_;
    }
}

template <vector_space Space>
void gram_inverse_hessian<Space>::forget(double length)
{
    memory_.forget();
    length_ = length;
}

template <vector_space Space>
void gram_inverse_hessian<Space>::multiply(const vector& g)
{
    vectors_[std::size_t(row_g())] = &g;
    const auto& used = memory_.used();
    std::vector<double> alpha(used.size());
    std::fill(c_.begin(), c_.end(), 0.0);
    c(row_g()) = 1; // q = g
    for (std::size_t k = used.size(); k-- > 0;)
    {
        alpha[k] = product(2 * used[k]) / memory_[used[k]].products.sy;
        c(2 * used[k] + 1) -= alpha[k];
    }
    if (h0_)
        apply_h0();
    else
        for (double& coefficient : c_) coefficient *= scale();
    for (std::size_t k = 0; k < used.size(); ++k)
    {
        const double beta = product(2 * used[k] + 1) / memory_[used[k]].products.sy;
        c(2 * used[k]) += alpha[k] - beta;
    }
}

template <vector_space Space>
direction_info gram_inverse_hessian<Space>::direction(double t, vector& d)
{
    for (double& coefficient : c_) coefficient = -coefficient;
    if (t != 0) c(2 * memory_.order().back()) += t;

    std::vector<double> coefficients;
    std::vector<const vector*> terms;
    double slope = 0, slope_terms = 0, square = 0;
    for (int i = 0; i < rows_; ++i)
    {
        if (c(i) == 0) continue;
        coefficients.push_back(c(i));
        terms.push_back(vectors_[std::size_t(i)]);
        slope += c(i) * gram(i, row_g());
        slope_terms += std::abs(c(i) * gram(i, row_g()));
        square += c(i) * product(i);
    }
    space_.linear_combination(coefficients, terms, d);

    // Sums that lost more than half of their digits are taken anew from the vectors.
    if (!(std::abs(slope) > 1e-8 * slope_terms)) slope = space_.dot(*vectors_[std::size_t(row_g())], d);
    if (!(square * gradient_squared() >= slope * slope * (1 - 1e-6))) square = space_.dot(d, d); // Cauchy-Schwarz
    return {slope, std::sqrt(square)};
}

template <vector_space Space>
double gram_inverse_hessian<Space>::propose(double a, const vector& d, const vector& g, const vector& g_new)
{
    const int p = memory_.spare();
    space_.axpby(a, d, 0, memory_[p].s);
    space_.linear_combination(std::array{1.0, -1.0}, std::array{&g_new, &g}, memory_[p].y);
    vectors_[std::size_t(row_new())] = &g_new;
    proposed_step_ = a;

    // The only wait of an iteration that is not the objective's: three rows of the Gram matrix.
    const std::array left{2 * p, 2 * p + 1, row_new()};
    std::vector<int> right(left.begin(), left.end());
    for (const int i : memory_.order()) right.insert(right.end(), {2 * i, 2 * i + 1});
    fetch(left, right);
    return gram(row_new(), 2 * p) / a;
}

template <vector_space Space>
bool gram_inverse_hessian<Space>::accept()
{
    const int p = memory_.spare();
    // The trial gradient is the current one from here on, and so is its row.
    for (int i = 0; i < row_g(); ++i) gram(row_g(), i) = gram(i, row_g()) = gram(row_new(), i);
    gram(row_g(), row_g()) = gram(row_new(), row_new());

    pair_products products{.sy = gram(2 * p, 2 * p + 1), .yy = gram(2 * p + 1, 2 * p + 1), .ss = gram(2 * p, 2 * p)};
    products.yhy = products.yy;
    if (h0_)
    {
        h0_(memory_[p].y, *r_);
        products.yhy = space_.dot(memory_[p].y, *r_);
    }
    skipped_ = !memory_.keep(products);
    if (!skipped_) step_ = proposed_step_;
    return !skipped_;
}

template <vector_space Space>
double gram_inverse_hessian<Space>::product(int row) const
{
    double sum = 0;
    for (int j = 0; j < rows_; ++j)
        if (c(j) != 0) sum += c(j) * gram(row, j); // unused rows hold anything
    return sum;
}

template <vector_space Space>
void gram_inverse_hessian<Space>::fetch(std::span<const int> left, std::span<const int> right)
{
    std::vector<const vector*> x, y;
    for (const int i : left) x.push_back(vectors_[std::size_t(i)]);
    for (const int j : right) y.push_back(vectors_[std::size_t(j)]);
    std::vector<double> out(x.size() * y.size());
    space_.multi_dot(x, y, out);
    for (std::size_t i = 0; i < left.size(); ++i)
        for (std::size_t j = 0; j < right.size(); ++j)
            gram(left[i], right[j]) = gram(right[j], left[i]) = out[i * y.size() + j];
}

template <vector_space Space>
void gram_inverse_hessian<Space>::apply_h0()
{
    std::vector<double> coefficients{1};
    std::vector<const vector*> terms{vectors_[std::size_t(row_g())]};
    std::vector<int> right{row_g(), row_r()};
    for (const int i : memory_.order())
    {
        coefficients.push_back(c(2 * i + 1));
        terms.push_back(vectors_[std::size_t(2 * i + 1)]);
        right.insert(right.end(), {2 * i, 2 * i + 1});
    }
    space_.linear_combination(coefficients, terms, *q_);
    h0_(*q_, *r_);
    fetch(std::array{row_r()}, right);
    std::fill(c_.begin(), c_.end(), 0.0);
    c(row_r()) = scale();
}

template <vector_space Space>
double gram_inverse_hessian<Space>::scale() const
{
    if (!memory_.empty()) return memory_.scale();
    return h0_ ? 1 : length_ / std::sqrt(gradient_squared());
}

/// The inverse Hessian of an objective, with its preconditioner as H0 where it has one. Refers to the objective.
template <objective Objective>
gram_inverse_hessian<space_of<Objective>> inverse_hessian(Objective& f, const memory_params& params)
{
    preconditioner<vector_of<Objective>> h0;
    if constexpr (has_precondition<Objective>)
        h0 = [&f](const vector_of<Objective>& v, vector_of<Objective>& out) { f.precondition(v, out); };
    return gram_inverse_hessian<space_of<Objective>>(f.space(), params, std::move(h0));
}

} // namespace taut::solve::impl
