// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/constrain/slide.hpp>
#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/mesh/cell_data.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/params.hpp>

namespace taut
{

/// Parameters of deform() and of sessions of volumes and planar meshes. Every field has a sensible default.
template <class Element>
struct deform_params
{
    static constexpr int D = Element::dimension;

    /// Energy to be minimised. A user's struct converts, alone or with parameters, as {cloth{}, {0.5}}; so do sums and
    /// products of energies.
    any_energy energy = impl::default_energy();

    /// Weights of elements in the sum: rest measure, as is usual, or all equal.
    energy::weighting weights = energy::weighting::measure;

    /// Data of single elements that energies read, in the order of the mesh.
    cell_data data = {};

    /// Pins, which are met bit for bit, and springs.
    taut::constraints<Element> constraints = {};

    /// True if the target shape of elements is a regular one, of the mean size, and the mesh has no rest shape.
    bool regular = false;

    /// Target shapes of single elements: the edges of each from its corner 0, as columns, up to a rotation. Empty, or
    /// one per element, none of them inverted. They are in the lengths of the mesh, in the place of the elements at
    /// rest; in the place of `regular` ones all are scaled to the size of the mesh.
    std::vector<mat<D>> targets = {};

    /// Owners of simplices that are the corners of cells of other kinds, and overlap (mesh/cell_corners.hpp).
    /// Certificates then say that all corners are positive.
    std::vector<idx> owners = {};

    /// Sliding constraints, at most one per vertex, none of a vertex with a pinned coordinate.
    std::vector<slide<D>> slides = {};

    /// Initial shape, if it is not that of the mesh, which is the one at rest: of the last step, say.
    std::vector<vec<D>> initial = {};

    taut::precision precision = precision::automatic;

    /// Solver parameters: stopping, and those of Newton's method, which is the `automatic` one here.
    solve::params solve = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (precision != precision::automatic && precision != precision::fp64 && precision != precision::mixed &&
            precision != precision::fp32)
            throw parameter_error("precision", "must be automatic, fp64, mixed or fp32");
        if (solve.method != solve::method::automatic && solve.method != solve::method::newton)
            throw parameter_error("solve.method", "must be automatic or newton");
        solve.validate();
        solve.require_newton_search();
    }
};

} // namespace taut
