// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

namespace taut
{

template <class Element>
std::vector<mesh_finding> check(const mesh<Element>& m, const mesh_requirements& need)
{
    return check(m, impl::facets(m), need);
}

template std::vector<mesh_finding> check<triangle>(const mesh<triangle>& m, const mesh_requirements& need);

template std::vector<mesh_finding> check<tetrahedron>(const mesh<tetrahedron>& m, const mesh_requirements& need);

template <class Element>
void validate(const mesh<Element>& m, const mesh_requirements& need)
{
    validate(m, impl::facets(m), need);
}

template void validate<triangle>(const mesh<triangle>& m, const mesh_requirements& need);

template void validate<tetrahedron>(const mesh<tetrahedron>& m, const mesh_requirements& need);

} // namespace taut

namespace taut::impl
{

template std::vector<mesh_finding> check(const mesh<triangle>&, const impl::facet_table&, const mesh_requirements&);
template std::vector<mesh_finding> check(const mesh<tetrahedron>&, const impl::facet_table&, const mesh_requirements&);

} // namespace taut::impl
