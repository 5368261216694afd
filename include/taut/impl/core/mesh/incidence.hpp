// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// The corners of each vertex, as corners * cell + k, in increasing order: what a gather of per-corner values reads
/// (paper, Fig. 8).
template <class Element>
csr vertex_corners(const mesh<Element>& m)
{
    constexpr std::size_t n = Element::corners;
    csr r;
    r.items.resize(m.cells().size() * n);
    r.offsets = impl::counting_sort(
        r.items.size(), m.points().size(), [&](std::size_t corner) { return m.cells()[corner / n][corner % n]; },
        [&](std::size_t corner, std::size_t position) { r.items[position] = static_cast<idx>(corner); });
    return r;
}

/// The cells of each vertex in increasing order.
template <class Element>
csr vertex_cells(const mesh<Element>& m)
{
    csr r = vertex_corners(m);
    for (idx& i : r.items) i /= Element::corners;
    return r;
}

/// The vertices that share a cell with each vertex, in increasing order, without itself.
template <class Element>
csr vertex_neighbours(const mesh<Element>& m)
{
    const csr around = vertex_corners(m);
    csr r;
    r.offsets.reserve(around.offsets.size());
    r.offsets.push_back(0);
    r.items.reserve(around.items.size() + around.items.size() / 2);
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const auto first = static_cast<std::ptrdiff_t>(r.items.size());
        for (const idx i : around.row(v))
            for (const idx w : m.cells()[static_cast<std::size_t>(i / Element::corners)])
                if (w != v) r.items.push_back(w);
        std::sort(r.items.begin() + first, r.items.end());
        r.items.erase(std::unique(r.items.begin() + first, r.items.end()), r.items.end());
        r.offsets.push_back(static_cast<idx>(r.items.size()));
    }
    return r;
}

// Compiled once, with the bodies.
extern template csr vertex_corners(const mesh<triangle>&);
extern template csr vertex_neighbours(const mesh<triangle>&);
extern template csr vertex_corners(const mesh<tetrahedron>&);
extern template csr vertex_neighbours(const mesh<tetrahedron>&);

} // namespace taut::impl
