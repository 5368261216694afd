// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atlas/atlas_source.hpp"

namespace taut::tools
{

/// NAME=FACTOR of --density.
struct part_density
{
    std::string name;
    double factor; ///< of lengths, positive and finite
};

/// Nothing for another text. Names may contain =.
std::optional<part_density> density_in(std::string_view text);

/// Factors of the texel density of all triangles of the files together; empty where none are given. A part that several
/// factors are for has their product.
/// inputs: as the command line has them; of several each is a part, too, by its path or its name
/// Throws unsuitable_input for a name that no part has.
std::vector<double> densities_of(const std::vector<std::unique_ptr<atlas_source>>& sources,
                                 std::span<const std::string> inputs, std::span<const std::string> given);

} // namespace taut::tools
