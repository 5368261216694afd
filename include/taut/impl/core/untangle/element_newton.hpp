// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>

#include <taut/impl/core/energy/regularized.hpp>
#include <taut/impl/core/objective/plane_newton.hpp>
#include <taut/impl/core/untangle/regularized_newton.hpp>

namespace taut::impl
{

/// Newton's method in the plane with a direct solver.
class triangle_newton final : public regularized_newton<triangle>
{
public:
    explicit triangle_newton(const regularized_problem<triangle>& problem);

    double value(const map& x) override;

    double step(map& x, double here) override
    {
        const double there = newton_.step(x, here, energy(), springs, proceed);
        length_ = newton_.last_length();
        return there;
    }

private:
    /// Regularised energy as a term of plane_newton.
    struct term : energy::impl::regularized<2>
    {
        bool barrier() const { return eps == 0; }
        double value(const std::array<vec2, 3>&, const mat2& S) const { return (*this)(S); }
    };

    term energy() const { return {{eps, area_weight_}}; }

    plane_newton<term> newton_;
};

inline std::unique_ptr<regularized_newton<triangle>> direct_newton(const regularized_problem<triangle>& problem)
{
    return std::make_unique<triangle_newton>(problem);
}

} // namespace taut::impl
