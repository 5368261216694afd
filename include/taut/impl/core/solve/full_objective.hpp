// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/objective.hpp>
#include <taut/impl/core/solve/objective_bodies.hpp>
#include <taut/solve_params.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace taut::solve::impl
{

/// Objective with all functions of the tables in objective.hpp, as methods use it: missing ones are composed of the
/// others, or report that they are missing. Refers to the objective.
template <objective O>
class full_objective
{
public:
    using point = typename O::point;
    using vector = vector_of<O>;

    explicit full_objective(O& f) : f_(f) {}

    decltype(auto) space() const { return f_.space(); }
    point make_point() const { return f_.make_point(); }
    void copy(const point& x, point& y) { f_.copy(x, y); }
    void step(const point& x, double a, const vector& d, point& out) { f_.step(x, a, d, out); }
    double value(const point& x) { return f_.value(x); }
    double value_gradient(const point& x, vector& g) { return f_.value_gradient(x, g); }

    double value_gradient(const point& x, vector& g, double& square)
    {
        if constexpr (requires { f_.value_gradient(x, g, square); })
            return f_.value_gradient(x, g, square);
        else
        {
            const double value = f_.value_gradient(x, g);
            square = f_.space().dot(g, g);
            return value;
        }
    }

    /// False, and nothing happens, where a gradient comes with a value and a wait.
    bool gradient(const point& x, vector& g)
    {
        if constexpr (requires { f_.gradient(x, g); }) return f_.gradient(x, g), true;
        return false;
    }

    double gradient_scale(const point& x, double at_start)
    {
        if constexpr (requires { f_.gradient_scale(x); }) return f_.gradient_scale(x);
        return at_start;
    }

    /// Scale of changes of f at this value.
    double size(double value) const
    {
        if constexpr (requires { f_.value_scale(); }) return std::max(std::abs(value), f_.value_scale());
        return std::abs(value);
    }

    double rounding() const
    {
        if constexpr (requires { f_.rounding(); }) return f_.rounding();
        return 0;
    }

    std::uint64_t waits() const
    {
        if constexpr (requires { f_.waits(); }) return f_.waits();
        return 0;
    }

    double max_step(const point& x, const vector& d)
    {
        if constexpr (requires { f_.max_step(x, d); }) return f_.max_step(x, d);
        return std::numeric_limits<double>::infinity();
    }

    std::vector<int> capping(const point& x, const vector& d)
    {
        if constexpr (requires { f_.capping(x, d); }) return f_.capping(x, d);
        return {};
    }

    /// True if values() takes one pass for all.
    static constexpr bool batches =
        requires(O & f, const point& x, const vector& d, std::span<const double> a, std::span<double> out)
    {
        f.values(x, d, a, out);
    };

    void values(const point& x, const vector& d, std::span<const double> a, std::span<double> out)
    {
        if constexpr (batches)
            f_.values(x, d, a, out);
        else
        {
            if (!trial_) trial_.emplace(f_.make_point());
            for (std::size_t i = 0; i < a.size(); ++i)
            {
                f_.copy(x, *trial_);
                f_.step(x, a[i], d, *trial_);
                out[i] = f_.value(*trial_);
            }
        }
    }

    double capped_values(const point& x, const vector& d, double fraction, std::span<const double> a,
                         std::span<double> out, double most = 1)
    {
        if constexpr (requires { f_.capped_values(x, d, fraction, a, out, most); })
            return f_.capped_values(x, d, fraction, a, out, most);
        else
        {
            const double unit = std::min(most, fraction * max_step(x, d));
            std::vector<double> steps;
            for (const double s : a) steps.push_back(unit * s);
            values(x, d, steps, out);
            return unit;
        }
    }

    /// Nothing, and nothing happens, where the full step has no place in the same wait.
    std::optional<std::pair<double, double>> capped_values(const point& x, const vector& d, double fraction,
                                                           std::span<const double> a, std::span<double> out,
                                                           point& full, vector& g)
    {
        if constexpr (requires { f_.capped_values(x, d, fraction, a, out, full, g); })
            return f_.capped_values(x, d, fraction, a, out, full, g);
        return std::nullopt;
    }

    /// True if there is anything to eliminate() with.
    static constexpr bool eliminates =
        requires(O & f, point& x, const vector& unexpected, const std::function<bool()>& proceed)
    {
        f.eliminate(x, unexpected, proceed);
    };

    /// Returns whether x was moved.
    bool relax(point& x)
    {
        if constexpr (requires { f_.relax(x); }) return f_.relax(x);
        return false;
    }

    /// Returns whether x was moved.
    bool eliminate(point& x, const vector& unexpected, const std::function<bool()>& proceed)
    {
        if constexpr (eliminates) return f_.eliminate(x, unexpected, proceed);
        return false;
    }

    /// False without a Hessian.
    bool linearize(const point& x, bool exact)
    {
        if constexpr (has_hessian<O>) return f_.linearize(x, exact), true;
        return false;
    }
    void hessian_product(const vector& v, vector& out) requires has_hessian<O> { f_.hessian_product(v, out); }
    void precondition(const vector& v, vector& out) requires has_precondition<O> { f_.precondition(v, out); }

private:
    O& f_;
    std::optional<point> trial_; // of values()
};

} // namespace taut::solve::impl
