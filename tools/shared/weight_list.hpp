// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <taut/types.hpp>

namespace taut::tools
{

/// Factors of vertices and of edges.
struct weight_list
{
    std::vector<double> of_vertices;               ///< one a vertex, 1 where none is given; empty if none is
    std::map<std::array<idx, 2>, double> of_edges; ///< the smaller vertex first
};

/// Factors of a text: a line has a vertex and its factor, or the two vertices of an edge and its factor, with blanks or
/// commas between; # begins a comment. Vertices are from 0 to vertices - 1, factors from 0.001 to 1000; of two the last
/// one counts. path: named in errors. Throws io_error.
weight_list parse_weights(std::string_view text, const std::string& path, idx vertices);

} // namespace taut::tools
