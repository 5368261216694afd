// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/impl/core/map/run_clock.hpp>
#include <taut/impl/core/objective/mapped_mesh.hpp>
#include <taut/options.hpp>
#include <taut/session.hpp>
#include <taut/solve_params.hpp>

namespace taut::impl
{

/// First map of a session.
template <class Element>
struct first_map
{
    session_result<Element> result; ///< without times and stages
    taut::precision precision;      ///< in which it was minimised
    double unit;                    ///< as mapped_mesh::unit
};

/// What an interactive session is of: all that differs between maps of surfaces, shapes and shells.
template <class Element>
struct session_setup
{
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    mapped_mesh<Element> of;
    taut::constraints<Element> constraints; ///< the initial ones
    std::vector<slide<D>> slides{};         ///< relative to the first map
    std::vector<idx> still{};               ///< vertices that keep their positions in the first map
    map start{};                            ///< first map, untangled where it is not injective; empty: `first`
    taut::precision precision = precision::automatic;
    solve::params solve{};
    run_limits limits{}; ///< time_limit: of the first map

    /// Computes the first map under constraints.
    std::function<first_map<Element>(const taut::constraints<Element>&, run_clock&)> first{};
};

} // namespace taut::impl
