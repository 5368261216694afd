// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/dist/constraints.hpp>
#include <taut/impl/dist/solver_params.hpp>
#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/params.hpp>

namespace taut::dist
{

/// Parameters of deform() and of sessions over many processes: those of taut::deform_params that are supported. All
/// processes give the same but for `constraints`, `initial` and `queue`.
template <class Element>
struct deform_params
{
    static constexpr int D = Element::dimension;

    /// Energy to be minimised. A user's struct converts, alone or with parameters, as {cloth{}, {0.5}}; so do sums and
    /// products of energies.
    any_energy energy = taut::impl::default_energy();

    /// Weights of elements in the sum: rest measure, as is usual, or all equal.
    energy::weighting weights = energy::weighting::measure;

    /// Pins, which are met bit for bit, and springs; of all processes together.
    dist::constraints<Element> constraints = {};

    /// True if the target shape of elements is a regular one, of the mean size, and the mesh has no rest shape.
    bool regular = false;

    /// Initial shape, if it is not that of the mesh: one position per vertex of the piece. No element is inverted.
    std::vector<vec<D>> initial = {};

    /// Precision; automatic is fp64.
    taut::precision precision = precision::automatic;

    /// Stopping and search of Newton's method.
    solve::params solve = {};

    /// Linear solver.
    impl::solver_params solver = {};

    /// Queue of this process. Without one: processes of a machine take its GPUs in turn, or share its CPU.
    std::optional<taut::queue> queue = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        solver.validate();
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (solve.method != solve::method::automatic && solve.method != solve::method::newton)
            throw parameter_error("solve.method", "must be automatic or newton");
        solve.validate();
        solve.require_newton_search();
    }
};

} // namespace taut::dist
