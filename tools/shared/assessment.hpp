// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/quality.hpp>

#include "shared/text_table.hpp"

namespace taut::tools
{

/// A map of a surface and everything the programs say about it.
struct assessment
{
    idx vertices = 0;     ///< of the surface
    bool measured = true; ///< false: nothing but quality.flips is known
    taut::quality quality;
    std::size_t left_out = 0;   ///< triangles without area at rest: counted in flips only
    std::size_t boundaries = 0; ///< boundary loops of the map, seams included
    std::optional<impl::crossing_count>
        crossings;                  ///< pairs of boundary edges that meet; unknown where an edge has 3 triangles
    std::size_t polygons = 0;       ///< faces of more than three corners that are convex in space
    std::vector<idx> concave;       ///< those that are not in the map
    std::size_t reversed_fans = 0;  ///< see count_reversed_fans()
    std::vector<std::string> notes; ///< what could not be measured, and why
};

/// Measures a map with one position a vertex.
assessment assess(const mesh<triangle>& surface, std::span<const vec2> uv);

/// Counts its flips alone, for those in a hurry.
assessment certified(const mesh<triangle>& surface, std::span<const vec2> uv);

/// Takes in how many convex polygons there are, and which are not convex in the map.
void take_polygons(assessment& a, const impl::convex_polygons& polygons, std::span<const vec2> uv);

/// The JSON members of that.
void add_polygons(nlohmann::ordered_json& json, const assessment& a);

/// The quality columns, null if nothing was measured. What is not a finite number becomes null.
nlohmann::ordered_json to_json(const assessment& a);

/// Energies and ratios of a map of triangles (dimension 2) or tetrahedra.
nlohmann::ordered_json to_json(const quality& q, int dimension);

/// A finite number, else null: JSON knows no others.
nlohmann::ordered_json finite(double x);

/// Adds the lines "flipped" and, if it was measured, "boundary".
void describe_validity(labelled_lines& lines, const assessment& a);

/// The rest for people, in two small tables; nothing if nothing was measured.
void print(std::ostream& out, const assessment& a);
void print(std::ostream& out, const quality& q, int dimension);

} // namespace taut::tools
