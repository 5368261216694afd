// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/descent.hpp>

#include <cmath>
#include <utility>

namespace taut::solve::impl
{

/// Coefficient beta of Algorithm 1, line 2, as a rule for `descent`. With s = a d_k of the step before, beta d_k =
/// (beta / a) s.
///
/// The paper prints beta = y'g / y'd, without H. That mixes preconditioned and plain terms and ruins the method; the
/// consistent form is y'H g / y'd, for which y'd_{k+1} = 0 whatever the line search. Since H_{k+1} y = s, it is
/// s'g_{k+1} / y'd_k: it corrects for inexact searches, and after an exact one the method is L-BFGS.
class conjugate_rule
{
public:
    explicit conjugate_rule(const conjugate_gradient_params& params) : params_(params) {}

    template <class Hessian>
    impl::momentum operator()(Hessian& h)
    {
        const double g_h_g = h.g_h_g();
        const double before = std::exchange(g_h_g_, g_h_g);
        if (h.fresh() || h.skipped())
        {
            since_ = 0;
            return {};
        }
        if (params_.restart_interval > 0 && ++since_ >= params_.restart_interval)
        {
            since_ = 0;
            return {.on_step = 0, .restart = true};
        }
        const double y_h_g = h.y_h_g();
        const double t = params_.beta == impl::conjugacy::hestenes_stiefel ? y_h_g / h.newest_products().sy
                                                                           : y_h_g / (before * h.newest_step());
        return {.on_step = t > 0 && std::isfinite(t) ? t : 0};
    }

private:
    conjugate_gradient_params params_;
    double g_h_g_ = 0; // of the iterate before
    int since_ = 0;    // iterations since the last restart
};

/// Minimises f from x by the paper's Algorithm 1: d_0 = -H_0 g_0, d_k = -H_k g_k + beta_k d_{k-1}. x ends at the best
/// iterate whatever the reason to stop. Throws parameter_error. Host waits as for lbfgs.
template <objective Objective>
report conjugate_gradient(Objective& f, typename Objective::point& x, const conjugate_gradient_params& params = {},
                          const descent_params& common = {}, const run_limits& limits = {})
{
    params.validate();
    common.validate();
    auto h = impl::inverse_hessian(f, params.memory);
    return impl::descent(f, x, h, conjugate_rule(params), common, limits).run();
}

} // namespace taut::solve::impl
