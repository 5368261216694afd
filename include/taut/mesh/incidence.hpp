// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <taut/mesh/mesh.hpp>

namespace taut
{

/// Rows of varying length: row r is items[offsets[r]] .. items[offsets[r + 1] - 1].
struct csr
{
    std::vector<index> offsets; ///< rows + 1
    std::vector<index> items;

    index rows() const { return static_cast<index>(offsets.size()) - 1; }
    std::span<const index> row(index r) const
    {
        const auto first = static_cast<std::size_t>(offsets[static_cast<std::size_t>(r)]);
        const auto last = static_cast<std::size_t>(offsets[static_cast<std::size_t>(r) + 1]);
        return {items.data() + first, last - first};
    }
};

/// The corners of each vertex, as corners * cell + k, in increasing order: what a gather of per-corner values reads
/// (paper, Fig. 8).
template <class Element>
csr vertex_corners(const mesh<Element>& m)
{
    csr r;
    r.offsets.assign(static_cast<std::size_t>(m.vertex_count()) + 1, 0);
    r.items.resize(static_cast<std::size_t>(m.cell_count()) * Element::corners);
    for (const auto& t : m.cells())
        for (const index v : t) ++r.offsets[static_cast<std::size_t>(v)];
    // Running ends; filling from the back turns them into starts and leaves each row sorted.
    for (std::size_t v = 1; v < r.offsets.size(); ++v) r.offsets[v] += r.offsets[v - 1];
    for (index c = m.cell_count(); c-- > 0;)
        for (index k = Element::corners; k-- > 0;)
        {
            const index v = m.cells()[static_cast<std::size_t>(c)][static_cast<std::size_t>(k)];
            r.items[static_cast<std::size_t>(--r.offsets[static_cast<std::size_t>(v)])] = Element::corners * c + k;
        }
    return r;
}

/// The cells of each vertex in increasing order.
template <class Element>
csr vertex_cells(const mesh<Element>& m)
{
    csr r = vertex_corners(m);
    for (index& i : r.items) i /= Element::corners;
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
    for (index v = 0; v < m.vertex_count(); ++v)
    {
        const auto first = static_cast<std::ptrdiff_t>(r.items.size());
        for (const index i : around.row(v))
            for (const index w : m.cells()[static_cast<std::size_t>(i / Element::corners)])
                if (w != v) r.items.push_back(w);
        std::sort(r.items.begin() + first, r.items.end());
        r.items.erase(std::unique(r.items.begin() + first, r.items.end()), r.items.end());
        r.offsets.push_back(static_cast<index>(r.items.size()));
    }
    return r;
}

} // namespace taut
