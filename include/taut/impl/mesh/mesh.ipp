// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/mesh.hpp>

namespace taut::impl
{

template std::string list_first_elements<triangle>(std::size_t, const std::vector<idx>&, std::span<const idx>);
template std::string list_first_elements<tetrahedron>(std::size_t, const std::vector<idx>&, std::span<const idx>);
template mesh_finding describe<triangle>(mesh_error::fault_type, std::vector<idx>, std::span<const idx>);
template mesh_finding describe<tetrahedron>(mesh_error::fault_type, std::vector<idx>, std::span<const idx>);

} // namespace taut::impl

namespace taut
{

template class mesh<triangle>;
template class mesh<tetrahedron>;

} // namespace taut
