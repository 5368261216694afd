// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <taut/untangle/state.hpp>

namespace taut
{

/// One way to make a map injective. A stage keeps where it stands, so that it can go on in a later round.
template <class Element>
class untangle_stage
{
public:
    virtual ~untangle_stage() = default;
    virtual std::string_view name() const = 0;

    /// Works for about `iterations` iterations, until the state has an injective map or says stop. It offers its maps
    /// to the state and calls proceed() after each iteration. False: it has nothing more to try.
    virtual bool run(untangle_state<Element>& state, int iterations) = 0;
};

} // namespace taut
