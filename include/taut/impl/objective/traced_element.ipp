// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/objective/traced_element.hpp>

namespace taut::impl
{

element_inputs::element_inputs(recording& r, const real_types& types, const any_energy& energy)
    : corners(r.in<idx>("corners")),
      inverse(r.in<double>("inverse", types.vector)),
      measure(r.in<double>("measure", types.vector)),
      weight(r.in<double>("weight", types.vector)),
      x(r.in<double>("x", types.position)),
      cell_stride(r.scalar<idx>("cell_stride")),
      vertex_stride(r.scalar<idx>("vertex_stride")),
      attribute_count(static_cast<int>(energy.attributes().size()))
{
    if (attribute_count > 0) attributes.emplace(r.in<double>("attributes", types.vector));
    if (energy.directions()) frames.emplace(r.in<double>("frames", types.vector));
    for (std::size_t k = 0; k < energy.parameters().size(); ++k)
        parameters.push_back(r.scalar<double>("parameter" + std::to_string(k), types.vector));
}

template class traced_element<2>;

} // namespace taut::impl
