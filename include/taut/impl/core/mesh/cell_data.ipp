// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include <taut/cell_data.hpp>
#include <taut/impl/core/mesh/cell_data.hpp>

namespace taut
{

void cell_data::validate(std::size_t cells) const
{
    const auto sized = [&](std::size_t n, std::size_t each, const char* field)
    {
        if (n != 0 && n != cells * each)
            throw parameter_error(field, std::to_string(n) + " numbers for " + std::to_string(cells) + " cells");
    };
    sized(weights.size(), 1, "data.weights");
    sized(attributes.size(), attribute_count, "data.attributes");
    sized(directions.size(), 1, "data.directions");
    if (attribute_count > 0 && attributes.empty()) throw parameter_error("data.attributes", "are missing");
    const auto refuse = [](const char* field, std::size_t c, const char* why)
    { throw parameter_error(field, "of cell " + std::to_string(c) + ' ' + why); };
    for (std::size_t c = 0; c < weights.size(); ++c)
        if (!(weights[c] >= 1e-100 && weights[c] <= 1e100)) // squares of gradients overflow beyond
            refuse("data.weights", c, "must be positive, from 1e-100 to 1e100");
    for (std::size_t i = 0; i < attributes.size(); ++i)
        if (!std::isfinite(attributes[i])) refuse("data.attributes", i / attribute_count, "must be finite");
    for (std::size_t c = 0; c < directions.size(); ++c)
    {
        const double length = glm::dot(directions[c], directions[c]);
        if (!(length > 0) || !std::isfinite(length)) refuse("data.directions", c, "must be finite and not zero");
    }
}

cell_data cell_data::reordered(const impl::permutation& cells) const
{
    cell_data r;
    r.attribute_count = attribute_count;
    if (!weights.empty()) r.weights = cells.apply(weights);
    if (!directions.empty()) r.directions = cells.apply(directions);
    for (const idx c : cells.new_to_old)
        for (std::size_t k = 0; k < attribute_count; ++k)
            r.attributes.push_back(attributes[static_cast<std::size_t>(c) * attribute_count + k]);
    return r;
}

} // namespace taut

namespace taut::impl
{

template averaged_cell_data::averaged_cell_data(const cell_data&, const std::vector<std::array<idx, 3>>&, std::size_t);
template cell_data averaged_cell_data::at(const std::vector<std::array<idx, 3>>&, const std::vector<idx>&) const;
template averaged_cell_data::averaged_cell_data(const cell_data&, const std::vector<std::array<idx, 4>>&, std::size_t);
template cell_data averaged_cell_data::at(const std::vector<std::array<idx, 4>>&, const std::vector<idx>&) const;

} // namespace taut::impl
