// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/validate.hpp>

namespace taut
{

template std::vector<impl::mesh_finding> check(const mesh<triangle>&, const impl::facet_table&,
                                               const impl::mesh_requirements&);
template std::vector<impl::mesh_finding> check(const mesh<tetrahedron>&, const impl::facet_table&,
                                               const impl::mesh_requirements&);

} // namespace taut
