// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <taut/constraints.hpp>

#include "options.hpp"

namespace taut::python
{

/// Pins and springs as rows: b, bc (a coordinate that is NaN is free), and spring_b, spring_bc, spring_w.
template <class Element>
constraints<Element> constraints_of(const mesh<Element>& m, const options& given)
{
    constexpr int D = Element::dimension;
    constraints<Element> wanted(m);
    if (const auto b = given.rows("b"))
    {
        const auto vertices = ids_of(*b);
        const auto places = points_of<D>(*given.rows("bc"), "bc");
        for (std::size_t i = 0; i < vertices.size(); ++i)
        {
            int free = 0;
            for (int k = 0; k < D; ++k) free += std::isnan(places[i][k]);
            if (free == 0)
                wanted.pin(vertices[i], places[i]);
            else
                for (int k = 0; k < D; ++k)
                    if (!std::isnan(places[i][k])) wanted.pin(vertices[i], k, places[i][k]);
        }
    }
    if (const auto b = given.rows("spring_b"))
    {
        const auto vertices = ids_of(*b);
        const auto places = points_of<D>(*given.rows("spring_bc"), "springs");
        const auto weights = numbers_of(*given.rows("spring_w"));
        for (std::size_t i = 0; i < vertices.size(); ++i) wanted.spring(vertices[i], places[i], weights[i]);
    }
    return wanted;
}

} // namespace taut::python
