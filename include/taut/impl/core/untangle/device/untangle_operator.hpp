// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/kernels/untangle.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/untangle/device/operator_arrays.hpp>
#include <taut/impl/core/untangle/device/operator_frame.hpp>
#include <taut/impl/core/untangle/device/operator_params.hpp>

namespace taut::impl
{

/// kernels/untangle.cl for dimension D, with so many items a group.
inline own_program untangle_program(int D, std::size_t items, lane_form form)
{
    return {.text = kernels::untangle,
            .host = host_untangle,
            .settings = {{"D", D}, {"L", items}, {"V", form.lanes}, {"C", form.slice}}};
}

/// Result of a run of the untangling operator.
template <int D>
struct operator_result
{
    std::vector<vec<D>> map; ///< map with the fewest inverted elements; fixed coordinates are those of the problem
    operator_stop why = operator_stop::iterations;
    int iterations = 0;              ///< moves made
    int best_iteration = 0;          ///< how many of them lead to the map
    std::size_t inverted_before = 0; ///< of the start, in exact arithmetic
    certificate after;               ///< of the map; det in the units of the map, not divided by anything
    double delta = 0;                ///< the last step length
    double seconds = 0;

    /// True if no element of the map is inverted.
    explicit operator bool() const { return static_cast<bool>(after); }
};

/// Untangles a map by topological operators on the device, in single precision (paper, section 3.3, Algorithm 2):
/// all vertices of inverted elements move at once along the gradient of +det, by a step that shrinks by a schedule and
/// not by a line search. It is quick where it works, never proves that a problem has no solution, and leaves the map
/// barely injective: a barrier energy should be minimised afterwards. Three launches per iteration; the host waits once
/// in params.batch of them. Device memory, in numbers of 4 bytes:
/// (D + 1)(D + 2) an element, or a little more, and 2 D + 1 a vertex.
template <class Element>
class untangle_operator
{
public:
    static constexpr int D = Element::dimension;

    /// Throws parameter_error for a problem that is not valid. The queue's device needs no double precision.
    untangle_operator(const queue& q, const untangle_problem<Element>& problem)
        : untangle_operator(q, problem, lane_form::for_device(q.device()))
    {
    }

    /// Makes the kernels in a given form rather than the one that suits the device.
    untangle_operator(queue q, const untangle_problem<Element>& problem, lane_form form)
        : problem_((problem.validate(), problem)),
          queue_(std::move(q)),
          arrays_(queue_, problem_, form),
          items_(form.lanes == 1 ? std::min<std::size_t>(256, power_of_two(queue_.device().max_group())) : 1),
          block_(padded((arrays_.cell_stride + most_groups - 1) / most_groups, form.lanes == 1 ? items_ : 512)),
          groups_((arrays_.cell_stride + block_ - 1) / block_),
          x_(queue_, D * arrays_.vertex_stride),
          best_(queue_, D * arrays_.vertex_stride),
          contributions_(queue_, (D + 1) * D * arrays_.cell_stride),
          partials_(queue_, 3 * groups_),
          state_(queue_, state_size)
    {
        const own_program program = untangle_program(D, items_, form);
        elements_ = make_kernel(queue_, program, "untangle_elements");
        decide_ = make_kernel(queue_, program, "untangle_decide");
        move_ = make_kernel(queue_, program, "untangle_move");
    }

    /// Untangles `start`, one point per vertex in the user's order, whose fixed coordinates are replaced by those of
    /// the problem. Throws parameter_error for parameters out of range and for a start of another size or with points
    /// that are not finite. The same input gives the same output on a device.
    operator_result<D> run(const std::vector<vec<D>>& start, const operator_params& params = {})
    {
        params.validate();
        budget limits(params.time_limit, params.observer);
        operator_result<D> r;
        r.map = with_held(start);
        r.after = exact(r.map);
        r.inverted_before = r.after.flipped;

        if (r.after && params.margin == 0)
        {
            r.why = operator_stop::untangled;
            r.seconds = limits.total();
            return r;
        }

        const std::vector<vec<D>> from = r.map;
        const operator_frame<D> frame(problem_.rest.cells(), from);
        const std::vector<float> first = to_local(from, frame);
        x_.upload(first);
        std::array<idx, state_size> state{};
        state[state_delta] = std::bit_cast<idx>(static_cast<float>(params.delta));
        state[state_value] = std::bit_cast<idx>(std::numeric_limits<float>::infinity());
        double goal = params.margin; // of det, to be lifted above it
        for (bool again = true; again;)
        {
            state[state_stop] = running;
            state[state_best_inverted] = state[state_best_below] = std::numeric_limits<idx>::max();
            state_.upload(state);
            r.why = iterate(params, goal + frame.rounding(), goal, limits, state);
            auto candidate = to_user(from, first, frame);
            const certificate c = exact(candidate);
            if (r.after.flipped > c.flipped || (!c.flipped && r.why == operator_stop::untangled))
            {
                r.map = std::move(candidate);
                r.after = c;
                r.best_iteration = state[state_best_iteration];
            }
            // Single precision saw no inverted element and there is one: ask for more.
            again = r.why == operator_stop::untangled && !r.after;
            goal = std::max(8 * goal, frame.rounding());
            if (again && goal > most_goal)
            {
                again = false;
                r.why = operator_stop::rounding;
            }
        }
        r.iterations = std::min(state[state_iteration], params.iterations);
        r.delta = static_cast<double>(std::bit_cast<float>(state[state_delta]));
        r.seconds = limits.total();
        return r;
    }

private:
    static constexpr std::size_t most_groups = 256;
    static constexpr double most_goal = 0.1;
    /// As in kernels/untangle.cl.
    enum : std::size_t
    {
        state_stop,
        state_iteration,
        state_improved,
        state_inverted,
        state_below,
        state_best_inverted,
        state_best_below,
        state_best_iteration,
        state_streak,
        state_delta,
        state_value,
        state_size
    };
    enum : idx
    {
        running,
        untangled,
        short_step,
        not_finite
    };

    static constexpr std::size_t power_of_two(std::size_t n) { return std::bit_floor(n); }

    certificate exact(const std::vector<vec<D>>& x) const
    {
        return certify<D>(problem_.rest.cells(), std::span<const vec<D>>(x), {}, 16, problem_.owners);
    }

    std::vector<vec<D>> with_held(std::vector<vec<D>> x) const
    {
        if (x.size() != problem_.initial.size())
            throw parameter_error("start", "one point a vertex: " + std::to_string(problem_.initial.size()) + ", not " +
                                               std::to_string(x.size()));
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int c = 0; c < D; ++c)
            {
                if (problem_.held.test(v, c)) x[v][c] = problem_.initial[v][c];
                if (!std::isfinite(x[v][c]))
                    throw parameter_error("start", "vertex " + std::to_string(v) + " is not finite");
            }
        return x;
    }

    std::vector<float> to_local(const std::vector<vec<D>>& x, const operator_frame<D>& frame) const
    {
        std::vector<float> local(D * arrays_.vertex_stride, 0.0F);
        for (std::size_t v = 0; v < x.size(); ++v)
            for (std::size_t c = 0; c < D; ++c)
                local[c * arrays_.vertex_stride + v] =
                    frame.here(x[arrays_.old_vertex(v)][static_cast<int>(c)], static_cast<int>(c));
        return local;
    }

    /// Best map in the user's numbering; coordinates that have not moved are those of `from`, bit for bit.
    std::vector<vec<D>> to_user(const std::vector<vec<D>>& from, const std::vector<float>& first,
                                const operator_frame<D>& frame) const
    {
        std::vector<vec<D>> x = from;
        const std::vector<float> local = best_.download();
        for (std::size_t v = 0; v < arrays_.moving; ++v)
            for (std::size_t c = 0; c < D; ++c)
            {
                const std::size_t i = c * arrays_.vertex_stride + v;
                if (local[i] != first[i])
                    x[arrays_.old_vertex(v)][static_cast<int>(c)] = frame.there(local[i], static_cast<int>(c));
            }
        return x;
    }

    /// Iterates until the device reports a reason to stop, or a limit is reached, or the observer returns false.
    operator_stop iterate(const operator_params& params, double margin, double goal, budget& limits,
                          std::array<idx, state_size>& state)
    {
        int batch = std::min(params.batch, 8);
        for (;;)
        {
            // The state after the last move is looked at, too.
            const std::int64_t left = std::int64_t{params.iterations} - state[state_iteration] + 1;
            const double before = limits.total();
            enqueue(std::min<std::int64_t>(batch, left), params, static_cast<float>(margin), static_cast<float>(goal));
            state_.download(state);
            switch (state[state_stop])
            {
            case untangled:
                return operator_stop::untangled;
            case short_step:
                return operator_stop::step;
            case not_finite:
                return operator_stop::not_finite;
            default:
                break;
            }
            if (batch >= left) return operator_stop::iterations;
            if (!limits.proceed(where(state))) return limits.refused() ? operator_stop::user : operator_stop::time;
            const bool slow = limits.total() - before > 0.1;
            batch = slow ? std::max(batch / 2, 1) : std::min(2 * batch, params.batch);
        }
    }

    void enqueue(std::int64_t iterations, const operator_params& params, float margin, float goal)
    {
        const auto cells = static_cast<idx>(arrays_.cell_stride), vertices = static_cast<idx>(arrays_.vertex_stride);
        for (std::int64_t i = 0; i < iterations; ++i)
        {
            elements_({groups_ * items_, items_}, {{"count", problem_.rest.cell_count()},
                                                   {"cells", cells},
                                                   {"vertices", vertices},
                                                   {"block", static_cast<idx>(block_)},
                                                   {"margin", margin},
                                                   {"goal", goal},
                                                   {"inverse_beta", 1 / params.beta},
                                                   {"shear", params.shear},
                                                   {"state", state_},
                                                   {"corners", arrays_.corners},
                                                   {"x", x_},
                                                   {"contributions", contributions_},
                                                   {"partials", partials_}});
            decide_({items_, items_}, {{"groups", static_cast<idx>(groups_)},
                                       {"patience", params.increases()},
                                       {"least_delta", params.least_delta},
                                       {"partials", partials_},
                                       {"state", state_}});
            move_(arrays_.rows(), {{"cells", cells},
                                   {"vertices", vertices},
                                   {"state", state_},
                                   {"offsets", arrays_.offsets},
                                   {"places", arrays_.places},
                                   {"held", arrays_.held},
                                   {"contributions", contributions_},
                                   {"x", x_},
                                   {"best", best_}});
        }
    }

    static progress where(const std::array<idx, state_size>& state)
    {
        progress p;
        p.iteration = state[state_iteration];
        p.evaluations = p.iteration;
        p.value = static_cast<double>(std::bit_cast<float>(state[state_value]));
        p.step = static_cast<double>(std::bit_cast<float>(state[state_delta]));
        return p;
    }

    untangle_problem<Element> problem_;
    queue queue_;
    operator_arrays<Element> arrays_;
    std::size_t items_; ///< of a group
    std::size_t block_; ///< cells of a group
    std::size_t groups_;
    buffer<float> x_, best_, contributions_, partials_;
    buffer<idx> state_;
    kernel elements_, decide_, move_;
};

} // namespace taut::impl
