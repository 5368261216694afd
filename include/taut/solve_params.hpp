// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_SOLVE_PARAMS_HPP
#define TAUT_SOLVE_PARAMS_HPP

#include <cmath>
#include <concepts>
#include <cstdint>
#include <locale>
#include <ostream>
#include <span>
#include <string_view>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/name_in.hpp>
#include <taut/impl/core/solve/objective.hpp>
#include <taut/impl/core/solve/tuning.hpp>

/// Parameters and reports of solvers, and what they need of a function and of its vectors.
namespace taut::solve
{

/// Reasons for which a minimisation ends. All of them are results, none is an exception; the best iterate is kept in
/// each case.
enum class stop
{
    gradient,        ///< the relative gradient fell below its tolerance: converged
    decrement,       ///< several Newton decrements in a row below what the tolerance asks for: converged
    settled,         ///< five Newton steps together gained next to nothing of a soft valley: converged
    decrease,        ///< several relative decreases in a row below the tolerance
    step,            ///< several relative steps in a row below the tolerance
    iterations,      ///< as many iterations as allowed
    line_search,     ///< no lower value along the direction, nor along steepest descent: often the limit of rounding
    barrier,         ///< the barrier cuts every step so short that nothing is gained
    time,            ///< the time limit
    user,            ///< the observer said so
    not_finite_start ///< value or gradient at the start is infinite or not a number
};

/// Stable name of a reason, for programs.
constexpr std::string_view to_string(stop reason) noexcept
{
    return taut::impl::name_in<stop::not_finite_start>({"gradient", "decrement", "settled", "decrease", "step",
                                                        "iterations", "line search", "barrier", "time", "user",
                                                        "start not finite"},
                                                       reason);
}

inline std::ostream& operator<<(std::ostream& stream, stop reason)
{
    return stream << to_string(reason);
}

/// Record of one accepted iterate; number 0 is the start.
struct history_entry
{
    int iteration = 0;
    double value = 0;        ///< f(x)
    double gradient = 0;     ///< relative norm of the gradient
    double step = 0;         ///< a in x + a d: 1 is the full step of the method
    bool capped = false;     ///< the barrier cut the step
    int evaluations = 0;     ///< values computed so far
    double seconds = 0;      ///< since the start of the run
    std::uint64_t waits = 0; ///< host waits for a device, since the start of the run
};

/// Report of a minimisation. Values in the history never increase by more than the rounding error of a value.
struct report
{
    solve::stop stop = solve::stop::iterations;
    int iterations = 0;       ///< accepted steps
    int evaluations = 0;      ///< values computed, those that came with a gradient included
    int gradients = 0;        ///< gradients computed
    int eliminations = 0;     ///< iterations after which parts were minimised by themselves (Newton's method)
    int products = 0;         ///< Hessian products, nearly all with a preconditioning (Newton's method)
    int restarts = 0;         ///< times the method discarded its memory of earlier steps
    int skipped_pairs = 0;    ///< steps without positive curvature, left out of the quasi-Newton memory
    double value_start = 0;   ///< f at the start
    double value = 0;         ///< f at the end
    double gradient_norm = 0; ///< relative norm of the gradient at the end
    double seconds = 0;       ///< wall-clock seconds of the whole run
    std::uint64_t waits = 0;  ///< host waits for a device (Newton's method)
    std::vector<int> capping; ///< parts of the problem whose barrier cut the last step of Newton's method, if one did
    std::vector<history_entry> history;
};

/// One line: `stop: gradient, 7 iterations, E 34.5 -> 7.446`.
std::ostream& operator<<(std::ostream& stream, const report& r);

/// Line search methods; the first is the default.
enum class line_search_method : int
{
    hybrid,       ///< the paper's: full step under strong Wolfe, else bracket and Brent
    strong_wolfe, ///< Nocedal & Wright 3.5, 3.6: a gradient at every trial
    backtracking  ///< Armijo only
};

// solve/line/line_search.hpp has their names, and includes them

/// Line search of the descent methods. Newton's method has a search of its own, which takes wolfe.sufficient_decrease,
/// barrier_fraction and rounding of the tuning alone.
struct line_search_params
{
    line_search_method method{};
    impl::line_tuning tuning = {};

    friend bool operator==(const line_search_params&, const line_search_params&) = default;

    void validate() const { tuning.validate(); }
};

/// Stopping criteria, as in solve::params.
struct stopping_params
{
    double gradient_tolerance = 1e-6;
    double decrease_tolerance = 1e-14;
    int max_iterations = 10000;
    impl::stopping_tuning tuning = {};

    void validate() const
    {
        const auto fraction = [](double t, const char* field)
        {
            if (!(t >= 0 && t < 1)) throw parameter_error(field, "must be in [0, 1)");
        };
        fraction(gradient_tolerance, "gradient_tolerance");
        fraction(decrease_tolerance, "decrease_tolerance");
        tuning.validate();
        if (max_iterations < 0) throw parameter_error("max_iterations", "must not be negative");
    }
};

/// Common parameters of all descent methods.
struct descent_params
{
    solve::line_search_params line_search = {};
    stopping_params stopping = {};

    /// Length of the first direction, a guess of the distance to go; a wrong one costs trial steps in the first
    /// iteration only. Range > 0. Unused with a preconditioner, whose scale is trusted.
    double first_length = 1;

    /// Relative decrease of the value after which an objective with a Hessian renews its preconditioner, and the method
    /// discards its pairs. Range > 0.
    double linearize_after = 0.03;

    void validate() const
    {
        line_search.validate();
        stopping.validate();
        if (!(first_length > 0) || !std::isfinite(first_length))
            throw parameter_error("first_length", "must be positive and finite");
        if (!(linearize_after > 0)) throw parameter_error("linearize_after", "must be positive");
    }
};

/// Minimisation methods.
enum class method
{
    automatic,          ///< newton where the objective has a Hessian, else lbfgs
    newton,             ///< truncated Newton: objectives with a Hessian only
    lbfgs,              ///< limited-memory BFGS, preconditioned where the objective can
    conjugate_gradient, ///< the paper's preconditioned nonlinear conjugate gradient
    gradient_descent    ///< steepest descent, for comparison
};

/// Parameters of minimize(). A tolerance of 0 switches its test off.
///
///     minimize(f, x, {.method = method::conjugate_gradient, .gradient_tolerance = 1e-8});
struct params
{
    solve::method method = solve::method::automatic;

    /// Line search of the descent methods: hybrid, the default, where values are cheaper than gradients; strong_wolfe
    /// where they come together anyway.
    line_search_method line_search{};

    /// Stop where |g| <= gradient_tolerance * scale; the scale is the objective's gradient_scale or |g| at the start.
    /// Range [0, 1). Lower it for results to more digits; below 1e-8 rounding of the gradient may win.
    ///
    /// A gradient is long where f is steep, not where much is left to gain. Newton's method stops, too, where the
    /// Hessian promises, twice in a row, a decrease of at most 1e-2 gradient_tolerance * |f - base|:
    /// Newton's decrement, which is the same in all units and scalings (Boyd & Vandenberghe 2004, 9.5).
    double gradient_tolerance = 1e-6;

    /// Stop after two decreases in a row of at most decrease_tolerance * |f - base|. A decrease along a step that a
    /// barrier cut is not counted; one that is lost in rounding is counted only where the gradient has reached no new
    /// low for ten steps (three of Newton's method). Range [0, 1). Raise it (1e-6) to stop where the value, not the
    /// point, matters.
    double decrease_tolerance = 1e-14;

    /// Range >= 0.
    int max_iterations = 10000;

    /// Not for users: what tests and measurements set.
    impl::tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        tuning.newton.validate();
        tuning.lbfgs.validate();
        tuning.conjugate_gradient.validate();
        common().validate();
        if (method == solve::method::newton) require_newton_search();
    }

    /// Throws parameter_error where a parameter is set that Newton's method does not use.
    void require_newton_search() const
    {
        const impl::tuning unset;
        const impl::line_tuning& line = tuning.line;
        const impl::line_tuning used{.wolfe = {.sufficient_decrease = line.wolfe.sufficient_decrease},
                                     .barrier_fraction = line.barrier_fraction,
                                     .rounding = line.rounding};
        if (line_search == line_search_method{} && line == used && tuning.first_length == unset.first_length &&
            tuning.linearize_after == unset.linearize_after)
            return;
        throw parameter_error("line_search", "Newton's method takes wolfe.sufficient_decrease, barrier_fraction and "
                                             "rounding alone; leave the rest as "
                                             "they are, or choose another method");
    }

    descent_params common() const
    {
        return {.line_search = {line_search, tuning.line},
                .stopping = {gradient_tolerance, decrease_tolerance, max_iterations, tuning.stopping},
                .first_length = tuning.first_length,
                .linearize_after = tuning.linearize_after};
    }
};

/// Vector space of a solver: eight lines of linear algebra and nothing of memory, devices or meshes. Vectors are opaque
/// and movable; scalars are double on the host whatever the vectors hold.
///
/// On a device each `dot` and `multi_dot` makes the host wait for the queue (tens of microseconds, as much as a small
/// kernel), while `copy`, `axpby` and `linear_combination` are only enqueued. The algorithms therefore ask for many
/// products in one `multi_dot`.
///
/// | call                              | meaning                                                                  |
/// |-----------------------------------|--------------------------------------------------------------------------|
/// | `make()`                          | a zero vector                                                            |
/// | `copy(x, y)`                      | y = x                                                                    |
/// | `axpby(a, x, b, y)`               | y = a x + b y; b == 0 never reads y                                      |
/// | `dot(x, y)`                       | x'y                                                                      |
/// | `multi_dot(left, right, out)`     | out[i * right.size() + j] = left[i]'right[j]                             |
/// | `linear_combination(a, x, out)`   | out = sum of a[i] x[i]; out may be x[0], and no other of them            |
template <class S>
concept vector_space = std::movable<typename S::vector> &&
    requires(S& space, const typename S::vector& x, typename S::vector& y, double a, std::span<const double> many,
             std::span<const typename S::vector* const> vectors, std::span<double> out)
{
    {
        space.make()
        } -> std::same_as<typename S::vector>;
    space.copy(x, y);
    space.axpby(a, x, a, y);
    {
        space.dot(x, x)
        } -> std::convertible_to<double>;
    space.multi_dot(vectors, vectors, out);
    space.linear_combination(many, vectors, y);
};

/// Objective f to be minimised. Points and vectors may be of different types: positions in double, gradients and
/// directions in float.
///
/// | call                        | meaning                                                                        |
/// |-----------------------------|--------------------------------------------------------------------------------|
/// | `space()`                   | the space of gradients and directions                                          |
/// | `make_point()`, `copy(x,y)` | a point of the right shape, y = x                                              |
/// | `value(x)`                  | f(x); +inf or NaN outside the domain                                           |
/// | `value_gradient(x, g)`      | f(x), and g = its gradient                                                     |
/// | `step(x, a, d, out)`        | out = x + a d                                                                  |
///
/// Optional, each by itself; full_objective says what methods do without:
///
/// | call                              | meaning                                                                  |
/// |-----------------------------------|--------------------------------------------------------------------------|
/// | `max_step(x, d)`                  | the first a > 0 at which x + a d meets a barrier; inf where it never     |
/// |                                   | does. No trial step goes beyond a fraction of it                         |
/// | `capping(x, d)`                   | numbers of the parts of the problem that meet the barrier first along d  |
/// | `values(x, d, a, out)`            | out[i] = f(x + a[i] d), several steps in one pass over the data          |
/// | `capped_values(x, d, u, a, out,   | out[i] = f(x + s a[i] d) with s = min(most, u max_step), which is        |
/// |  most)`                           | returned: the barrier and several trial steps in one wait                |
/// | `capped_values(..., out, full, g)`| with most = 1; in the same wait full = x + d and g = its gradient; the   |
/// |                                   | pair of s and the norm of g squared. For steps that are expected to be   |
/// |                                   | taken in full                                                            |
/// | `value_gradient(x, g, square)`    | also the norm of the gradient squared, in the same wait                  |
/// | `gradient(x, g)`                  | g = the gradient, without the value and without a wait                   |
/// | `gradient_scale(x)`               | the norm of a gradient that is typical for the problem, in which         |
/// |                                   | relative gradients are measured; without it, the norm at the start       |
/// | `value_scale()`                   | a rise of f that is typical for the problem, below which values do not   |
/// |                                   | say what is much or little; without it, 0                                |
/// | `relax(x)`                        | lowers f by other means than steps along one direction; whether it moved |
/// | `eliminate(x, unexpected,         | the same, where it is farthest from quadratic: there the vectors of      |
/// |  proceed)`                        | `unexpected`, a gradient less what a model expected, are longest; asks   |
/// |                                   | proceed() whether to go on                                               |
/// | `rounding()`                      | the rounding error of a value by the larger of the value and its scale,  |
/// |                                   | where it is above that of double                                         |
/// | `waits()`                         | how often the host has waited for a device so far                        |
template <class O>
concept objective = vector_space<impl::space_of<O>> &&
    requires(O& f, const typename O::point& x, typename O::point& out, double a, const impl::vector_of<O>& d,
             impl::vector_of<O>& g)
{
    {
        f.make_point()
        } -> std::same_as<typename O::point>;
    f.copy(x, out);
    {
        f.value(x)
        } -> std::convertible_to<double>;
    {
        f.value_gradient(x, g)
        } -> std::convertible_to<double>;
    f.step(x, a, d, out);
};

} // namespace taut::solve

#endif
#include <taut/impl/leave.inl>
