// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <span>

namespace taut::solve::impl
{

/// A trial step a with phi(a) = f(x + a d) and, where it was asked for, phi'(a) = grad f(x + a d)'d.
struct line_point
{
    double step = 0;
    double value = std::numeric_limits<double>::infinity();
    double slope = std::numeric_limits<double>::quiet_NaN();
};

/// Outcomes of a line search.
enum class search_status
{
    accepted,   ///< a step that lowers the value; the line's gradient is the one at the step
    failed,     ///< none
    interrupted ///< time or user
};

struct search_result
{
    search_status status = search_status::failed;
    line_point at;
};

/// Line function phi of a line search. Values outside the domain are +inf, never NaN, and so is every value once
/// interrupted() is true: searches then run dry and their caller asks why.
///
/// | call                       | meaning                                                                         |
/// |----------------------------|---------------------------------------------------------------------------------|
/// | `start()`                  | phi(0) and phi'(0) < 0                                                          |
/// | `bound()`                  | the longest step allowed, inf without a barrier                                 |
/// | `noise()`                  | the rounding error of a value                                                   |
/// | `ceiling()`                | the highest value that is no increase: the lowest, plus noise                 |
/// | `batch()`                  | how many values cost as much as one; 1 if they are computed one by one          |
/// | `value(a)`, `values(a, v)` | phi at one step, at several                                                     |
/// | `value_gradient(a)`        | phi(a), and keeps the gradient there                                            |
/// | `slope()`                  | phi' where the gradient was taken last                                          |
/// | `best()`                   | the step a > 0 of lowest value so far; NaN in its slope                         |
/// | `interrupted()`            | whether to give up                                                              |
template <class L>
concept line_function = requires(L& phi, double a, std::span<const double> steps, std::span<double> values)
{
    {
        phi.start()
        } -> std::convertible_to<impl::line_point>;
    {
        phi.bound()
        } -> std::convertible_to<double>;
    {
        phi.ceiling()
        } -> std::convertible_to<double>;
    {
        phi.batch()
        } -> std::convertible_to<int>;
    {
        phi.value(a)
        } -> std::convertible_to<double>;
    phi.values(steps, values);
    {
        phi.value_gradient(a)
        } -> std::convertible_to<double>;
    {
        phi.slope()
        } -> std::convertible_to<double>;
    {
        phi.best()
        } -> std::convertible_to<impl::line_point>;
    {
        phi.interrupted()
        } -> std::convertible_to<bool>;
};

/// Non-finite values are outside the domain.
inline double finite_or_inf(double value) noexcept
{
    return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

/// Returns whether a step is so short that phi cannot change by more than rounding along it: no use to try a shorter
/// one.
template <line_function Line>
bool lost_in_rounding(Line& phi, double step)
{
    return step * std::abs(line_point(phi.start()).slope) < phi.noise();
}

/// The end of every search: the gradient at a chosen step, checked once more, since `value` and `value_gradient` may
/// round differently.
template <line_function Line>
search_result land(Line& phi, double step)
{
    line_point at{.step = step, .value = phi.value_gradient(step)};
    if (phi.interrupted()) return {search_status::interrupted, at};
    if (!(at.value <= phi.ceiling())) return {search_status::failed, at};
    at.slope = phi.slope();
    return {std::isfinite(at.slope) ? search_status::accepted : search_status::failed, at};
}

} // namespace taut::solve::impl
