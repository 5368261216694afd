// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include <taut/impl/core/untangle/state.hpp>

namespace taut::impl
{

/// Method of making a map injective. A stage keeps its state, so that it can continue in a later round.
template <class Element>
class untangle_stage
{
public:
    virtual ~untangle_stage() = default;
    virtual std::string_view name() const = 0;

    /// Works for about `iterations` iterations, until the state has an injective map or ends the run. It offers its
    /// maps to the state and calls proceed() after each iteration. Returns false if it cannot continue.
    virtual bool run(untangle_state<Element>& state, int iterations) = 0;
};

/// In their order.
template <class Element>
using untangle_stages = std::vector<std::unique_ptr<untangle_stage<Element>>>;

} // namespace taut::impl
