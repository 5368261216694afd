// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve.hpp>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace taut::solve::impl
{

/// The inverse Hessian H_k of L-BFGS by the two-loop recursion, every product a `dot` of its own: the reference that
/// gram_inverse_hessian is tested against, and as good as it where a dot costs nothing but its arithmetic.
///
/// Source: Nocedal & Wright, Algorithms 7.4 and 7.5; the paper's (20), (21).
///
/// | here            | there               |
/// |-----------------|---------------------|
/// | `s, y`          | s_i, y_i            |
/// | `sy`            | 1 / rho_i           |
/// | `alpha, beta`   | alpha_i, beta       |
/// | `q_`, `r_`      | q, r                |
template <vector_space Space>
class two_loop_inverse_hessian
{
public:
    using vector = typename Space::vector;

    two_loop_inverse_hessian(Space& space, const memory_params& params, preconditioner<vector> h0 = {})
        : space_(space), memory_(space, params), h0_(std::move(h0)), q_(space.make()), r_(space.make())
    {
    }

    /// The first gradient.
    void start(const vector& g) { gg_ = space_.dot(g, g); }

    /// Drops all pairs; the next direction has about this length.
    void forget(double length)
    {
        memory_.forget();
        length_ = length;
    }

    /// No pairs: the next direction is steepest descent.
    bool fresh() const noexcept { return memory_.empty(); }

    /// The pair of the last step was left out: the newest pair is older than that.
    bool skipped() const noexcept { return skipped_; }

    /// |g|^2 of the current gradient.
    double gradient_squared() const noexcept { return gg_; }

    /// r = H g for the current gradient.
    void multiply(const vector& g)
    {
        g_ = &g;
        const auto& used = memory_.used();
        std::vector<double> alpha(used.size());
        space_.copy(g, q_);
        // First loop, newest to oldest; second loop, oldest to newest: Algorithm 7.4.
        for (std::size_t k = used.size(); k-- > 0;)
        {
            const auto& [s, y, p] = memory_[used[k]];
            alpha[k] = space_.dot(s, q_) / p.sy;
            space_.axpby(-alpha[k], y, 1, q_);
        }
        if (h0_)
        {
            h0_(q_, r_);
            std::swap(q_, r_);
        }
        space_.axpby(scale(), q_, 0, r_);
        for (std::size_t k = 0; k < used.size(); ++k)
        {
            const auto& [s, y, p] = memory_[used[k]];
            const double beta = space_.dot(y, r_) / p.sy;
            space_.axpby(alpha[k] - beta, s, 1, r_);
        }
    }

    /// g'H g, after multiply.
    double g_h_g() { return space_.dot(*g_, r_); }

    /// y'H g with the newest y, after multiply.
    double y_h_g() { return space_.dot(newest().y, r_); }

    /// Inner products of the newest pair.
    const pair_products& newest_products() const { return newest().products; }

    /// The step a of the newest pair, s = a d.
    double newest_step() const noexcept { return step_; }

    /// d = -H g + t s with the newest s, after multiply.
    direction_info direction(double t, vector& d)
    {
        space_.axpby(-1, r_, 0, d);
        if (t != 0) space_.axpby(t, newest().s, 1, d);
        return {space_.dot(*g_, d), std::sqrt(space_.dot(d, d))};
    }

    /// The trial pair s = a d, y = g_new - g; returns d'g_new.
    double propose(double a, const vector& d, const vector& g, const vector& g_new)
    {
        auto& [s, y, p] = memory_[memory_.spare()];
        space_.axpby(a, d, 0, s);
        space_.copy(g_new, y);
        space_.axpby(-1, g, 1, y);
        g_new_ = &g_new;
        proposed_step_ = a;
        return space_.dot(d, g_new);
    }

    /// The trial pair and its gradient become the newest; false where the pair is left out for its curvature.
    bool accept()
    {
        const auto& [s, y, old] = memory_[memory_.spare()];
        pair_products p{.sy = space_.dot(s, y), .yy = space_.dot(y, y), .ss = space_.dot(s, s)};
        p.yhy = p.yy;
        if (h0_)
        {
            h0_(y, r_);
            p.yhy = space_.dot(y, r_);
        }
        gg_ = space_.dot(*g_new_, *g_new_);
        skipped_ = !memory_.keep(p);
        if (!skipped_) step_ = proposed_step_;
        return !skipped_;
    }

private:
    const auto& newest() const { return memory_[memory_.order().back()]; }

    double scale() const
    {
        if (!memory_.empty()) return memory_.scale();
        return h0_ ? 1 : length_ / std::sqrt(gg_);
    }

    Space& space_;
    pair_memory<Space> memory_;
    preconditioner<vector> h0_;
    vector q_, r_;
    const vector* g_ = nullptr;
    const vector* g_new_ = nullptr;
    double gg_ = 0, length_ = 1, step_ = 1, proposed_step_ = 1;
    bool skipped_ = false;
};

/// minimize() by L-BFGS or conjugate gradients with that form.
template <objective Objective>
report minimize_by_two_loops(Objective& f, typename Objective::point& x, const params& p)
{
    preconditioner<vector_of<Objective>> h0;
    if constexpr (has_precondition<Objective>)
        h0 = [&f](const vector_of<Objective>& v, vector_of<Objective>& out) { f.precondition(v, out); };
    const bool cg = p.method == method::conjugate_gradient;
    two_loop_inverse_hessian<space_of<Objective>> h(
        f.space(), cg ? p.tuning.conjugate_gradient.memory : p.tuning.lbfgs.memory, h0);
    const run_limits none;
    if (cg) return descent(f, x, h, conjugate_rule(p.tuning.conjugate_gradient), p.common(), none).run();
    return descent(f, x, h, no_momentum{}, p.common(), none).run();
}

} // namespace taut::solve::impl
