// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>

#include "atlas/atlas_source.hpp"

namespace taut::tools
{

/// One flag a triangle: those of the charts of the file's texture coordinates that have one of the faces which the file
/// `path` names. f: facets of the surface. Throws io_error, unsuitable_input, and
/// usage_error where these are all triangles.
std::vector<char> pinned_of(const atlas_source& source, const impl::facet_table& f, const std::string& path);

} // namespace taut::tools
