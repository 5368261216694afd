// SPDX-License-Identifier: MIT
#pragma once

#include <taut/energy.hpp>
#include <taut/mesh.hpp>
#include <taut/options.hpp>
#include <taut/parameterize.hpp>

#include "control.hpp"
#include "options.hpp"

namespace taut::python
{

/// Precision and stopping of calls that minimise.
template <class Params>
void read_solver(Params& params, const options& given)
{
    given.read_word("precision", params.precision,
                    {{"auto", precision::automatic},
                     {"fp64", precision::fp64},
                     {"mixed", precision::mixed},
                     {"fp32", precision::fp32}});
    given.read("tolerance", params.solve.gradient_tolerance);
    given.read("iterations", params.solve.max_iterations);
}

/// The clock of a call, and who watches.
inline run_limits limits_of(const options& given, const std::shared_ptr<control>& watched, const char* stage)
{
    run_limits limits;
    given.read_seconds("time_limit", limits.time_limit);
    limits.observer = watched->observer(stage);
    return limits;
}

inline cell_data data_of(const options& given)
{
    cell_data data;
    if (const auto a = given.rows("weights")) data.weights = numbers_of(*a);
    if (const auto a = given.rows("attributes"))
    {
        data.attribute_count = a->ndim() == 2 ? a->shape(1) : 1;
        data.attributes = numbers_of(*a);
    }
    if (const auto a = given.rows("directions")) data.directions = places_of(*a, "directions");
    return data;
}

template <class Params>
void read_energy(Params& params, const options& given)
{
    if (any_energy energy = params.energy; given.read("energy", energy)) params.energy = energy;
    params.data = data_of(given);
    if (const auto a = given.rows("parameters")) params.energy = params.energy.with_parameters(numbers_of(*a));
    given.read_word("weighting", params.weights,
                    {{"area", energy::weighting::measure},
                     {"volume", energy::weighting::measure},
                     {"uniform", energy::weighting::uniform}});
}

} // namespace taut::python
