// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve_params.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace taut::solve::impl
{

/// Result of preconditioned conjugate gradients.
struct pcg_result
{
    int steps = 0;               ///< dimension of the space where the model was minimised
    int looks = 0;               ///< host waits
    double gradient_squared = 0; ///< |g|^2
    double slope = 0;            ///< g'd
    double decrease = 0;   ///< decrease of the model g'd + d'A d / 2 up to where its curvature turns negative, >= 0
    bool negative = false; ///< a direction of negative curvature was met, and is a part of d
};

/// Preconditioned conjugate gradients: the minimiser d of the model g'd + d'A d / 2 over the Krylov space of M A and M
/// g, which is what k steps of preconditioned conjugate gradients from 0 reach (Nocedal & Wright, Algorithm 5.3). The
/// s-step form (Chronopoulos & Gear 1989): a block of s vectors is made without any inner product, then all products
/// come in one wait, and the small system of the model is solved on the host. A block is conjugate to all before it
/// once it is to the last. The polynomials of the block are products of M A - theta (a Newton basis: Bai, Hu, Reichel
/// 1994), as powers of M A would soon be parallel in float; theta runs over where a good M has the spectrum of M A.
///
/// Where the next direction n of conjugate gradients has a negative curvature, the model has no minimiser, and falls
/// along n for ever. d is then what was found before and as much of n as makes g'd twice what it was: how far it is to
/// go is left to a line search.
///
/// | here       | meaning                                             |
/// |------------|-----------------------------------------------------|
/// | `z_, w_`   | the new block M r, (M A - theta) M r, ..., A z      |
/// | `p_, q_`   | the last block, conjugate, and A times it           |
/// | `K_`       | p'A p                                               |
/// | `B`        | p = z - p_last B                                    |
/// | `r_`       | the residual g + A d                                |
template <vector_space Space>
class pcg
{
public:
    using vector = typename Space::vector;
    using product = std::function<void(const vector& v, vector& out)>;

    pcg(Space& space, const pcg_params& params);

    /// A(v, out) and M(v, out) are the products, M symmetric positive definite on the space of g. proceed() is asked
    /// between blocks of steps; once it returns false, d is the current direction. max_steps: in the place of
    /// pcg_params::max_steps, unless it is 0. known: a direction with a likely component in d; the last step of the
    /// first block, which takes no preconditioning. If it brings much, the iteration continues.
    /// noise: of values; where the model falls by no more, a negative curvature is taken for rounding, too.
    pcg_result solve(const vector& g, const product& A, const product& M, vector& d,
                     const std::function<bool()>& proceed = {}, int max_steps = 0, const vector* known = nullptr,
                     double noise = 0);

private:
    using small = std::vector<std::vector<double>>;

    struct products
    {
        small zw, qz; ///< z'A z; q_last'z
        std::vector<double> zr;
        double rr = 0;
    };

    std::size_t most() const { return static_cast<std::size_t>(params_.block); }

    /// s vectors in z_ and w_.
    void make_block(std::size_t s, const product& A, const product& M);

    /// One more vector in z_ and w_.
    void append(const vector& v, const product& A);

    void drop_last(small& K);

    /// All inner products of the block: one wait.
    products multiply(bool first) const;

    /// B = K_last^-1 q_last'z, column by column.
    small conjugation(const small& qz) const;

    /// p'A p = z'A z - B'K_last B.
    small curvature(const small& zw, const small& B) const;

    /// d += p c, with p = z - p_last B; d = p c the first time.
    void add(const std::vector<double>& c, const small& B, vector& d, bool first);

    /// Makes the block the last one, and the residual that of the new d.
    void advance(const std::vector<double>& c, const small& B, const small& K);

    /// A linear combination, term by term.
    struct sum_of
    {
        void add(double factor, const vector& term)
        {
            factors.push_back(factor);
            terms.push_back(&term);
        }
        void make(Space& space, vector& out) const { space.linear_combination(factors, terms, out); }

        std::vector<double> factors;
        std::vector<const vector*> terms;
    };

    /// The c with K c = -b for the first k unknowns; empty if that part of K is not positive definite.
    static std::vector<double> minimiser(const small& K, const std::vector<double>& b, std::size_t k);

    /// The k-th vector made conjugate to those before it, along which the model falls with a negative curvature; empty
    /// if rounding may have made that, or where the residual is negligible. b: slopes; gained: the decrease so far. The
    /// first k - 1 rows of K are positive definite.
    static std::vector<double> descent(const small& K, const std::vector<double>& b, std::size_t k, double gained);

    static small matrix(std::size_t rows, std::size_t columns);

    static std::vector<const vector*> pointers(const std::vector<vector>& v);

    Space& space_;
    pcg_params params_;
    std::size_t size_; // of the next block
    vector r_;
    std::vector<vector> z_, w_, p_, q_;
    small K_;
};

template <vector_space Space>
pcg<Space>::pcg(Space& space, const pcg_params& params)
    : space_(space), params_(params), size_(std::min<std::size_t>(2, most())), r_(space.make())
{
}

template <vector_space Space>
pcg_result pcg<Space>::solve(const vector& g, const product& A, const product& M, vector& d,
                             const std::function<bool()>& proceed, int max_steps, const vector* known, double noise)
{
    if (max_steps == 0) max_steps = params_.max_steps;
    pcg_result result;
    std::size_t needed = 0; // steps until the last one brought little
    space_.copy(g, r_);
    for (bool more = true; more && result.steps < max_steps;)
    {
        const bool first = result.steps == 0;
        if (!first && proceed && !proceed()) break;
        const bool augmented = first && known && max_steps > 1;
        const std::size_t s = std::min(size_, static_cast<std::size_t>(max_steps - result.steps - (augmented ? 1 : 0)));
        make_block(s, A, M);
        if (augmented) append(*known, A);
        const products in = multiply(first);
        ++result.looks;
        if (first) result.gradient_squared = in.rr;
        const small B = first ? small() : conjugation(in.qz);
        small K = curvature(in.zw, B);

        // Step by step, so that the last one before a negative curvature counts.
        std::vector<double> c, n;
        double gained = 0, last = 0;
        for (std::size_t k = 1; k <= z_.size(); ++k)
        {
            auto longer = minimiser(K, in.zr, k);
            more = !longer.empty();
            if (!more)
            {
                const double fallen = result.decrease + gained;
                if ((result.steps > 0 || k > 1) && fallen > noise) n = descent(K, in.zr, k, fallen);
                if (k > s && n.empty()) // what is known lies in the space already
                {
                    drop_last(K);
                    more = true;
                }
                break;
            }
            double decrease = 0;
            for (std::size_t i = 0; i < k; ++i) decrease -= 0.5 * longer[i] * in.zr[i];
            last = decrease - std::exchange(gained, decrease);
            c = std::move(longer);
            if (first && needed == 0 && !(last > params_.gain * decrease / double(k))) needed = k;
        }
        // Without curvature to go by: steepest descent in the metric of M, and further than M says, since the way
        // only gets steeper.
        if (c.empty() && first)
        {
            constexpr double reach = 8; // a line search tries its eighth, too
            space_.axpby(-reach, z_[0], 0, d);
            result.steps = 1;
            result.slope = -reach * in.zr[0];
            result.negative = true;
            return result;
        }
        result.steps += int(c.size());
        result.decrease += gained;
        if (!n.empty())
        {
            double slope = 0;
            for (std::size_t i = 0; i < n.size(); ++i) slope += n[i] * in.zr[i];
            const double length = -2 * result.decrease / slope;
            c.resize(n.size(), 0.0);
            for (std::size_t i = 0; i < n.size(); ++i) c[i] += length * n[i];
            result.negative = true;
        }
        add(c, B, d, first);
        if (!first) last = gained / double(s);
        more = more && last > params_.gain * result.decrease / result.steps && result.steps < max_steps;
        if (more) advance(c, B, K);
    }
    // Who needed more than was expected will need yet more: systems are solved the better, the nearer the end.
    if (needed == 0) needed = static_cast<std::size_t>(result.steps) + 1;
    size_ = std::clamp(needed, std::min<std::size_t>(2, most()), most());
    result.slope = -2 * result.decrease; // d is the minimiser in its space
    if (result.negative) result.slope *= 2;
    return result;
}

template <vector_space Space>
void pcg<Space>::make_block(std::size_t s, const product& A, const product& M)
{
    constexpr double theta[] = {1.0, 0.3, 0.65, 0.85, 0.45, 0.95, 0.2};
    for (auto* block : {&z_, &w_})
    {
        block->resize(std::min(block->size(), s));
        while (block->size() < s) block->push_back(space_.make());
    }
    for (std::size_t k = 0; k < s; ++k)
    {
        M(k == 0 ? r_ : w_[k - 1], z_[k]);
        if (k > 0) space_.axpby(-theta[k - 1], z_[k - 1], 1, z_[k]);
        A(z_[k], w_[k]);
    }
}

template <vector_space Space>
void pcg<Space>::append(const vector& v, const product& A)
{
    for (auto* block : {&z_, &w_}) block->push_back(space_.make());
    space_.copy(v, z_.back());
    A(z_.back(), w_.back());
}

template <vector_space Space>
void pcg<Space>::drop_last(small& K)
{
    z_.pop_back();
    w_.pop_back();
    K.pop_back();
}

template <vector_space Space>
auto pcg<Space>::multiply(bool first) const -> products
{
    auto left = pointers(z_), right = pointers(w_);
    left.push_back(&r_);
    right.push_back(&r_);
    if (!first)
        for (const vector& q : q_) right.push_back(&q);
    std::vector<double> all(left.size() * right.size());
    space_.multi_dot(left, right, all);
    const auto at = [&](std::size_t i, std::size_t j) { return all[i * right.size() + j]; };
    const std::size_t s = z_.size(), before = first ? 0 : q_.size();
    products in{matrix(s, s), matrix(before, s), std::vector<double>(s), at(s, s)};
    for (std::size_t i = 0; i < s; ++i)
    {
        in.zr[i] = at(i, s);
        for (std::size_t j = 0; j < s; ++j) in.zw[i][j] = at(i, j);
        for (std::size_t j = 0; j < before; ++j) in.qz[j][i] = at(i, s + 1 + j);
    }
    return in;
}

template <vector_space Space>
auto pcg<Space>::conjugation(const small& qz) const -> small
{
    small B = matrix(q_.size(), z_.size());
    for (std::size_t j = 0; j < z_.size(); ++j)
    {
        std::vector<double> column(q_.size());
        for (std::size_t i = 0; i < q_.size(); ++i) column[i] = -qz[i][j];
        const auto solved = minimiser(K_, column, q_.size());
        for (std::size_t i = 0; i < solved.size(); ++i) B[i][j] = solved[i];
    }
    return B;
}

template <vector_space Space>
auto pcg<Space>::curvature(const small& zw, const small& B) const -> small
{
    small K = zw;
    if (B.empty()) return K;
    for (std::size_t i = 0; i < K.size(); ++i)
        for (std::size_t j = 0; j < K.size(); ++j)
            for (std::size_t m = 0; m < B.size(); ++m)
                for (std::size_t n = 0; n < B.size(); ++n) K[i][j] -= B[m][i] * K_[m][n] * B[n][j];
    return K;
}

template <vector_space Space>
void pcg<Space>::add(const std::vector<double>& c, const small& B, vector& d, bool first)
{
    sum_of sum;
    if (!first) sum.add(1, d);
    for (std::size_t k = 0; k < c.size(); ++k) sum.add(c[k], z_[k]);
    for (std::size_t i = 0; i < B.size(); ++i)
    {
        double factor = 0;
        for (std::size_t k = 0; k < c.size(); ++k) factor -= B[i][k] * c[k];
        sum.add(factor, p_[i]);
    }
    sum.make(space_, d);
}

template <vector_space Space>
void pcg<Space>::advance(const std::vector<double>& c, const small& B, const small& K)
{
    for (std::size_t k = 0; k < z_.size() && !B.empty(); ++k)
        for (auto [next, last] : {std::pair(&z_[k], &p_), std::pair(&w_[k], &q_)})
        {
            sum_of sum;
            sum.add(1, *next);
            for (std::size_t i = 0; i < B.size(); ++i) sum.add(-B[i][k], (*last)[i]);
            sum.make(space_, *next);
        }
    std::swap(p_, z_);
    std::swap(q_, w_);
    K_ = K;
    sum_of sum;
    sum.add(1, r_);
    for (std::size_t k = 0; k < c.size(); ++k) sum.add(c[k], q_[k]);
    sum.make(space_, r_);
}

template <vector_space Space>
std::vector<double> pcg<Space>::minimiser(const small& K, const std::vector<double>& b, std::size_t k)
{
    constexpr double least_pivot = 1e-6; // of a diagonal entry: below, in float, two vectors are one
    small L(k, std::vector<double>(k, 0.0));
    std::vector<double> c(k);
    for (std::size_t i = 0; i < k; ++i)
    {
        double sum = -b[i];
        for (std::size_t j = 0; j <= i; ++j)
        {
            double s = K[i][j];
            for (std::size_t m = 0; m < j; ++m) s -= L[i][m] * L[j][m];
            if (j < i)
                sum -= (L[i][j] = s / L[j][j]) * c[j];
            else if (!(s > least_pivot * K[i][i]) || !(K[i][i] > 0) || !std::isfinite(s + sum))
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

template <vector_space Space>
std::vector<double> pcg<Space>::descent(const small& K, const std::vector<double>& b, std::size_t k, double gained)
{
    constexpr double least = 1e-6; // as in minimiser()
    constexpr double least_slope = 1e-8;
    std::vector<double> row(K[k - 1].begin(), K[k - 1].begin() + std::ptrdiff_t(k - 1));
    auto n = minimiser(K, row, k - 1);
    n.push_back(1);
    double curvature = 0, slope = 0, terms = 0; // terms: of which the curvature is the difference
    for (std::size_t i = 0; i < k; ++i)
    {
        curvature += n[i] * K[k - 1][i];
        slope += n[i] * b[i];
        for (std::size_t j = 0; j < k; ++j) terms += std::abs(n[i] * K[i][j] * n[j]);
    }
    if (!(curvature < -least * terms) || !(std::abs(slope) > least_slope * gained)) return {};
    if (slope > 0)
        for (double& x : n) x = -x;
    return n;
}

template <vector_space Space>
auto pcg<Space>::matrix(std::size_t rows, std::size_t columns) -> small
{
    return small(rows, std::vector<double>(columns, 0.0));
}

template <vector_space Space>
auto pcg<Space>::pointers(const std::vector<vector>& v) -> std::vector<const vector*>
{
    std::vector<const vector*> all;
    for (const vector& x : v) all.push_back(&x);
    return all;
}

} // namespace taut::solve::impl
