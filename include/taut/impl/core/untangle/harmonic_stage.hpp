// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <taut/impl/core/untangle/stage.hpp>

namespace taut::impl
{

/// Harmonic map: each free coordinate at the mean of its neighbours', by one sparse solve. It is injective where the
/// boundary is convex and nothing inside is fixed, and else often a better start than the initial map.
template <class Element>
class harmonic_stage final : public untangle_stage<Element>
{
public:
    std::string_view name() const override { return "harmonic"; }

    bool run(untangle_state<Element>& state, int) override
    {
        state.offer(state.harmonic());
        state.proceed();
        return false;
    }
};

} // namespace taut::impl
