// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <taut/energies.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/quality.hpp>

namespace taut
{

template <class Element>
std::vector<double> distortion(const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    return distortion(m, impl::ideal_elements<Element>(m), x, energy::isometric{});
}

template std::vector<double> distortion<triangle>(const mesh<triangle>& m, std::span<const vec<triangle::dimension>> x);

template std::vector<double> distortion<tetrahedron>(const mesh<tetrahedron>& m,
                                                     std::span<const vec<tetrahedron::dimension>> x);

} // namespace taut
