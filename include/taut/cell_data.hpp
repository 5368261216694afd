// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_CELL_DATA_HPP
#define TAUT_CELL_DATA_HPP

#include <cstddef>
#include <vector>

#include <taut/impl/core/mesh/order.hpp>

/// Numbers of cells that energies read.
namespace taut
{

/// Data of the cells of a mesh, in its order: weights, parameters that energies read, and directions for anisotropic
/// energies. All parts are optional.
struct cell_data
{
    /// One per cell, from 1e-100 to 1e100: a factor of its weight in the sum of energies (a painted importance).
    std::vector<double> weights = {};

    /// Numbers per cell, attribute k of cell c at [c * attribute_count + k]; an energy reads e.attribute(k).
    std::size_t attribute_count = 0;
    std::vector<double> attributes = {};

    /// One per cell, of any length, in space: the first axis of the frame of S at rest, projected to the cell (the warp
    /// of a cloth, the fibre of a composite). Without them the frame is the element's own, along its first edge.
    std::vector<vec3> directions = {};

    bool empty() const { return weights.empty() && attributes.empty() && directions.empty(); }

    /// Throws parameter_error that names the field and the cell.
    void validate(std::size_t cells) const;

    /// For cells in other numbers.
    cell_data reordered(const impl::permutation& cells) const;

    /// The mean of each attribute over the cells.
    std::vector<double> mean_attributes() const
    {
        std::vector<double> means(attribute_count, 0.0);
        const std::size_t cells = attribute_count ? attributes.size() / attribute_count : 0;
        for (std::size_t i = 0; i < attributes.size(); ++i)
            means[i % attribute_count] += attributes[i] / static_cast<double>(cells);
        return means;
    }
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
