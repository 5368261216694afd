// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/start/harmonic.hpp>
#include <taut/impl/core/untangle/laid.hpp>
#include <taut/impl/core/untangle/stage.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Variants of the stage below.
struct pull_stage_params
{
    std::string name;
    bool regular = false;   ///< target shapes of triangles; else as they are in the map that it starts from
    double area_weight = 1; ///< of det + 1 / det against the shape of a triangle; 0: shape alone
    /// Continues with weak springs once strong ones have jammed: fixed vertices that are not at their targets go to
    /// random positions first, so that those that block each other get past each other.
    bool detours = false;
    int share = 1; ///< it makes so many times the iterations of a round
};

/// Penalty method from an injective map: springs pull the fixed vertices to their targets, stronger with every step,
/// against a barrier energy. No triangle becomes flat, so no branch point is created. The start fixes the boundary
/// alone, where that is injective, and nothing otherwise.
class pull_stage final : public untangle_stage<triangle>
{
public:
    explicit pull_stage(pull_stage_params params) : params_(std::move(params)) {}

    std::string_view name() const override { return params_.name; }

    bool run(untangle_state<triangle>& state, int iterations) override;

private:
    static constexpr double growth = 1.2;

    /// Starts the stage; returns false if there is no injective map to start from.
    bool start(untangle_state<triangle>& state);

    /// Harmonic map within the fixed part of the boundary, if it is injective.
    bool hold_boundary(const untangle_state<triangle>& state);

    bool hold_nothing(const untangle_state<triangle>& state)
    {
        auto laid = impl::laid_start(state.problem(), state.initial(), state.draft());
        if (!laid) return false;
        x_ = std::move(*laid);
        held_ = fixed_marks<2>(x_.size());
        return injective(state.problem().rest);
    }

    bool injective(const mesh<triangle>& m) const
    {
        return static_cast<bool>(certify<2>(m.cells(), std::span<const vec2>(x_)));
    }

    /// Switches from the targets to detours, or back.
    void turn();

    pull_stage_params params_;
    std::unique_ptr<regularized_newton<triangle>> newton_;
    fixed_marks<2> held_; // by newton_
    std::vector<vec2> x_;
    std::mt19937 random_{1};
    int standing_ = 0;  // steps in a row that could not be made
    int pulled_ = 0;    // steps since the springs were weak
    bool away_ = false; // on a detour
    double reach_ = 0;  // of detours
    std::vector<directed_spring<2>> places_;
};

} // namespace taut::impl
