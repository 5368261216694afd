// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

#include <taut/impl/core/untangle/pull_stage.hpp>

namespace taut::impl
{

bool pull_stage::run(untangle_state<triangle>& state, int iterations)
{
    if (state.injective() || (!newton_ && !start(state))) return false;
    newton_->proceed = [&state] { return state.proceed(0); };
    for (int i = 0; i / params_.share < iterations; ++i)
    {
        for (auto& s : newton_->springs) s.stiffness *= growth;
        const double before = newton_->value(x_), after = newton_->step(x_, before);
        state.stepped(before, after, newton_->last_length());
        if (state.offer(x_)) return false; // injective with the fixed vertices at their targets
        if (!state.proceed() || !std::isfinite(after)) return false;
        standing_ = after < before ? 0 : standing_ + 1;
        ++pulled_;
        if (standing_ <= 5 && (!params_.detours || pulled_ < (away_ ? 40 : 100))) continue;
        if (!params_.detours) return false;
        turn();
    }
    return true;
}

bool pull_stage::start(untangle_state<triangle>& state)
{
    const auto& problem = state.problem();
    if (!hold_boundary(state) && !hold_nothing(state)) return false;
    const double measure = impl::expected_measure(problem, state.initial());
    regularized_problem<triangle> pulled{.rest = problem.rest, .held = held_, .area_weight = params_.area_weight};
    if (params_.regular)
        pulled.shapes = impl::regular_shapes(problem.rest, measure);
    else
    {
        std::vector<vec3> points;
        for (const vec2& p : x_) points.emplace_back(p, 0.0);
        pulled.shapes = impl::rest_shapes(mesh<triangle>(std::move(points), state.cells()), measure);
    }
    for (std::size_t v = 0; v < held_.size(); ++v)
    {
        const auto is_pulled = [&](int k) { return problem.held.test(v, k) && !held_.test(v, k); };
        if (is_pulled(0) || is_pulled(1))
            pulled.springs.push_back({static_cast<idx>(v), state.initial()[v], vec2(is_pulled(0), is_pulled(1))});
    }
    for (auto& s : pulled.springs) s.stiffness /= static_cast<double>(pulled.springs.size());
    newton_ = state.make_newton(std::move(pulled));
    vec2 low = x_.front(), high = low;
    for (const vec2& p : x_)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    reach_ = glm::length(high - low) / 2;
    return true;
}

bool pull_stage::hold_boundary(const untangle_state<triangle>& state)
{
    untangle_problem<triangle> rim = state.problem();
    std::vector<char> on_boundary(rim.held.size(), 0);
    for (const auto& edge : boundary_facets(rim.rest))
        for (const idx v : edge) on_boundary[static_cast<std::size_t>(v)] = 1;
    for (std::size_t v = 0; v < rim.held.size(); ++v)
        if (!on_boundary[v]) rim.held[v] = 0;
    if (!rim.held.any()) return false;
    x_ = impl::harmonic_start(rim, state.initial());
    held_ = std::move(rim.held);
    return injective(rim.rest);
}

void pull_stage::turn()
{
    standing_ = pulled_ = 0;
    away_ = !away_;
    const auto uniform = [this] { return static_cast<double>(random_()) / random_.max(); };
    if (away_) places_ = newton_->springs;
    for (std::size_t i = 0; i < places_.size(); ++i)
    {
        auto& s = newton_->springs[i];
        s.target = places_[i].target;
        const double stiffness = std::exp(2 * uniform() - 1) / static_cast<double>(places_.size());
        for (int k = 0; k < 2; ++k)
            if (s.stiffness[k] > 0) s.stiffness[k] = stiffness;
        const vec2 off =
            vec2(glm::greaterThan(s.stiffness, vec2(0))) * (x_[static_cast<std::size_t>(s.vertex)] - s.target);
        if (!away_ || glm::length(off) < 1e-3 * reach_ || uniform() > 0.7) continue;
        const double angle = 2 * std::numbers::pi * uniform();
        s.target += reach_ * uniform() * vec2(std::cos(angle), std::sin(angle));
    }
}

} // namespace taut::impl
