// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include <taut/impl/core/energy/regularized.hpp>

namespace taut::impl
{

/// Schedule of the regularisation parameter, lowered after every minimisation as by Garanzha et al. 2021 (section 3.2):
/// chi of the worst element decreases by a fraction sigma, the relative decrease of the energy, with a minimum. They
/// take 1/10 as the minimum. Here it depends on the length t of the Newton step, pace * sqrt(t): after a shortened step
/// the minimisation for the current epsilon is not finished. The pace is high at first, which solves most problems in a
/// third of the steps; it can leave a few elements inverted at an epsilon where the method stagnates. Hence restarts,
/// each with a large epsilon again, half the pace and twice the steps.
class epsilon_schedule
{
public:
    /// least: smallest det S at the start.
    explicit epsilon_schedule(double least) : eps_(least > 0 ? floor : 0.2 * std::hypot(5e-6, least)) {}

    double eps() const { return eps_; }

    /// After a minimisation from value `before` to `after` by a step of length t; `least` is the smallest det S.
    void lower(double before, double after, double t, double least)
    {
        if (++steps_ == span_)
        {
            steps_ = 0;
            span_ *= 2;
            pace_ /= 2;
            eps_ = std::max({eps_, std::abs(least), 0.01});
            return;
        }
        const double sigma = std::clamp(1 - after / before, std::clamp(pace_ * std::sqrt(t), 0.1 * pace_, pace_), 0.9);
        const double chi = (1 - sigma) * energy::impl::regularized<2>{.eps = eps_}.chi(least);
        eps_ = least < chi ? std::max(floor, 2 * std::sqrt(chi * (chi - least))) : floor;
    }

private:
    static constexpr double floor = 1e-12;
    double eps_, pace_ = 0.3;
    int steps_ = 0, span_ = 45;
};

} // namespace taut::impl
