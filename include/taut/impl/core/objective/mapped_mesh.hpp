// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/cell_data.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

namespace taut::impl
{

/// Parameters of a map or a shape, with data bound to the user's energy. Throws parameter_error.
template <class Params>
Params validated(Params p)
{
    p.validate();
    p.energy = p.energy.with_data(p.data.mean_attributes(), !p.data.directions.empty());
    return p;
}

/// Mesh that is mapped, in normalised units, and the energy of its maps.
template <class Element>
struct mapped_mesh
{
    static constexpr int D = Element::dimension;

    mesh<Element> rest;
    ideal_elements<Element> ideal{rest}; ///< of the elements at rest, or other target shapes
    any_energy energy = default_energy();
    energy::weighting weights = energy::weighting::measure;
    cell_data data{};
    std::vector<mat<D>> targets{}; ///< target shapes of untangling, as in an untangle_problem; none: those at rest
    std::vector<idx> owners{};     ///< as there
    double unit = 1;               ///< normalised lengths by those of maps
    std::optional<mesh<triangle>> surface{}; ///< of hinges: whose triangles are certified

    std::vector<vec<D>> scaled(std::vector<vec<D>> x) const
    {
        for (vec<D>& p : x) p *= unit;
        return x;
    }
    std::vector<vec<D>> unscaled(std::vector<vec<D>> x) const
    {
        for (vec<D>& p : x) p /= unit;
        return x;
    }
};

} // namespace taut::impl
