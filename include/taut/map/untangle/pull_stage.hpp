// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/map/untangle/harmonic_start.hpp>
#include <taut/map/untangle/laid_start.hpp>
#include <taut/map/untangle/triangle_newton.hpp>
#include <taut/map/untangle/untangle_stage.hpp>
#include <taut/mesh/boundary.hpp>

namespace taut
{

/// Starts from an injective map and stays injective: springs pull the held vertices to their places, stronger with
/// every step, against an energy with a barrier whose rest shapes are those of the start. The start holds the boundary
/// alone, where that is injective, and nothing otherwise.
class pull_stage final : public untangle_stage<triangle>
{
public:
    std::string_view name() const override { return "pull"; }

    bool run(untangle_state<triangle>& state, int iterations) override
    {
        if (state.injective() || (!newton_ && !start(state))) return false;
        newton_->proceed = [&state] { return state.proceed(0); };
        for (int i = 0; i < iterations; ++i)
        {
            for (auto& s : newton_->springs) s.stiffness *= growth;
            const double before = newton_->value(x_), after = newton_->step(x_, before);
            const std::size_t inverted = state.offer(x_); // with the held vertices at their places
            if (inverted == 0 || !state.proceed() || !std::isfinite(after)) return false;
            standing_ = after < before ? 0 : standing_ + 1;
            if (standing_ > 5) return false;
        }
        return true;
    }

private:
    static constexpr double growth = 1.2;

    /// False if there is no injective map to start from.
    bool start(const untangle_state<triangle>& state)
    {
        const auto& problem = state.problem();
        untangle_problem<triangle> rim = problem;
        std::vector<char> on_boundary(rim.held.size(), 0);
        for (const auto& edge : boundary_facets(problem.rest))
            for (const index v : edge) on_boundary[static_cast<std::size_t>(v)] = 1;
        for (std::size_t v = 0; v < rim.held.size(); ++v)
            if (!on_boundary[v]) rim.held[v] = 0;
        x_ = detail::harmonic_start(rim, state.initial());
        if (!injective(problem.rest))
        {
            auto laid = detail::laid_start(problem, state.initial());
            if (!laid) return false;
            x_ = std::move(*laid);
            if (!injective(problem.rest)) return false;
            rim.held.assign(rim.held.size(), 0);
        }
        held_ = rim.held;

        newton_ = std::make_unique<detail::triangle_newton>(state.cells(), held_);
        std::vector<vec3> points;
        for (const vec2& p : x_) points.emplace_back(p, 0.0);
        newton_->shapes = detail::rest_shapes(mesh<triangle>(std::move(points), state.cells()),
                                              detail::expected_measure(problem, state.initial()));
        for (std::size_t v = 0; v < held_.size(); ++v)
            if (const std::uint8_t pulled = problem.held[v] & static_cast<std::uint8_t>(~held_[v]))
                newton_->springs.push_back({v, state.initial()[v], vec2(pulled & 1u, pulled >> 1 & 1u)});
        for (auto& s : newton_->springs) s.stiffness /= static_cast<double>(newton_->springs.size());
        return true;
    }

    bool injective(const mesh<triangle>& m) const
    {
        return static_cast<bool>(certify<2>(m.cells(), std::span<const vec2>(x_)));
    }

    std::unique_ptr<detail::triangle_newton> newton_;
    std::vector<std::uint8_t> held_; // by newton_
    std::vector<vec2> x_;
    int standing_ = 0; // steps in a row that could not be made
};

} // namespace taut
