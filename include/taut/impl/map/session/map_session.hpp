// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <utility>

#include <taut/impl/map/parameterize.hpp>
#include <taut/impl/map/session/session_steps.hpp>

namespace taut::impl
{

// Implementation of session.hpp; include that one.

/// Session of a map of a surface, with the start of parameterize().
template <class Element>
class map_session final : public session_steps<Element>
{
    using base = session_steps<Element>;
    using base::last, base::wanted;

public:
    map_session(const queue& q, const mesh<Element>& m, const parameterize_params& params)
        : base(q, params), params_(validated(params)), in_(m, params_)
    {
        wanted = params_.constraints.on(in_.surface);
    }

private:
    void begin(run_clock& clock) override
    {
        params_.constraints = wanted;
        map_result first = mapped(this->queue_, in_, params_, clock);
        session_report& r = last.report = {};
        r.outcome = first.report.outcome;
        r.reason = std::move(first.report.reason);
        r.ids = std::move(first.report.ids);
        r.notes = std::move(first.report.notes);
        r.flips = std::move(first.report.flips);
        r.energy = first.report.solve.value;
        r.gradient = first.report.solve.gradient_norm;
        r.steps = first.report.solve.iterations;
        if (first)
        {
            this->lengths_ = in_.unit / first.report.scale;
            this->held_ = held_places<Element>(first.uv, in_.fixed_boundary(params_.boundary));
            this->live_.emplace(this->queue_, in_.surface, params_, first.report.precision, this->scaled(first.uv));
            last.x = std::move(first.uv);
            this->constrain();
            r.pins_held = true;
            r.converged = solve::impl::converged(first.report.solve.stop);
            this->changed = false;
        }
        this->seconds_.start = clock.total();
        clock.stages.add({.stage = "prepare", .vertices = in_.surface.points().size()});
    }

    const mesh<Element>& rest() const override { return in_.surface; }
    std::span<const double> rest_measure() const override { return in_.ideal.measure; }

    parameterize_params params_; ///< validated
    run_surface in_;
};

} // namespace taut::impl

namespace taut
{

template <class Element>
session<Element>::session(queue& q, const mesh<Element>& m,
                          const parameterize_params& params) requires std::same_as<Element, triangle>
    : body_(std::make_unique<impl::map_session<Element>>(q, m, params))
{
}

} // namespace taut
