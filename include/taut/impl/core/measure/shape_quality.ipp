// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/measure/shape_quality.hpp>
#include <taut/mesh.hpp>
#include <taut/quality.hpp>

namespace taut
{

template <class Element>
shape_quality measure_shapes(const std::vector<typename mesh<Element>::cell>& cells,
                             std::span<const vec<Element::dimension>> x)
{
    return shape_quality(
        impl::shapes_of<Element>(cells, x, [](std::size_t, const auto& corners) { return impl::shape_of(corners); }));
}

template shape_quality measure_shapes<triangle>(const std::vector<mesh<triangle>::cell>& cells,
                                                std::span<const vec<triangle::dimension>> x);

template shape_quality measure_shapes<tetrahedron>(const std::vector<mesh<tetrahedron>::cell>& cells,
                                                   std::span<const vec<tetrahedron::dimension>> x);

template <class Element>
shape_quality measure_shapes(const std::vector<typename mesh<Element>::cell>& simplices,
                             std::span<const vec<Element::dimension>> x, std::span<const idx> owners,
                             std::span<const mat<Element::dimension>> regular)
{
    const auto alone = [&](std::size_t c)
    { return (c == 0 || owners[c - 1] != owners[c]) && (c + 1 == owners.size() || owners[c + 1] != owners[c]); };
    const auto corners =
        impl::shapes_of<Element>(simplices, x,
                                 [&](std::size_t c, const auto& corner) {
                                     return alone(c) ? impl::shape_of(corner) : impl::corner_shape(corner, regular[c]);
                                 });
    std::vector<element_shape> shapes;
    std::vector<idx> ids;
    for (std::size_t c = 0; c < corners.size(); ++c)
        if (c > 0 && owners[c] == owners[c - 1])
            shapes.back().join(corners[c]);
        else
        {
            shapes.push_back(corners[c]);
            ids.push_back(owners[c]);
        }
    return shape_quality(shapes, ids);
}

template shape_quality measure_shapes<triangle>(const std::vector<mesh<triangle>::cell>& simplices,
                                                std::span<const vec<triangle::dimension>> x,
                                                std::span<const idx> owners,
                                                std::span<const mat<triangle::dimension>> regular);

template shape_quality measure_shapes<tetrahedron>(const std::vector<mesh<tetrahedron>::cell>& simplices,
                                                   std::span<const vec<tetrahedron::dimension>> x,
                                                   std::span<const idx> owners,
                                                   std::span<const mat<tetrahedron::dimension>> regular);

} // namespace taut
