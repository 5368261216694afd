// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <taut/mesh/mesh.hpp>

namespace taut
{

/// Facets (edges of triangles, faces of tetrahedra) with their two sides. Side s = corners * cell + k is the facet of
/// `cell` opposite its corner k.
struct facet_table
{
    static constexpr index boundary = -1; ///< the side has no other side
    static constexpr index crowded = -2;  ///< three or more cells share the facet

    std::vector<index> twin;                 ///< other side of each side, or boundary, or crowded
    std::vector<std::array<index, 2>> clash; ///< pairs of sides that run the same way: one cell is turned over
    std::vector<std::vector<index>> crowds;  ///< the sides of each facet with three or more

    bool manifold() const { return crowds.empty(); }                  ///< at most two cells a facet
    bool oriented() const { return crowds.empty() && clash.empty(); } ///< and neighbours agree
};

/// The vertices of a side, oriented as the boundary of its cell.
template <class Element>
std::array<index, Element::dimension> side_vertices(const mesh<Element>& m, index side)
{
    const auto& t = m.cells()[static_cast<std::size_t>(side / Element::corners)];
    const auto& local = Element::facets[static_cast<std::size_t>(side % Element::corners)];
    std::array<index, Element::dimension> v;
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = t[static_cast<std::size_t>(local[k])];
    return v;
}

namespace detail
{

/// A side in the bucket of its smallest vertex: its other vertices in increasing order, then its number and direction.
template <int D>
struct side_key
{
    std::array<index, D - 1> rest;
    std::uint32_t tag; // 2 * side + (the vertices are an odd permutation of the sorted ones)

    index side() const { return static_cast<index>(tag >> 1); }
    bool operator<(const side_key& o) const { return rest != o.rest ? rest < o.rest : tag < o.tag; }
};

/// Sorts the vertices of a side and splits off the smallest.
template <int D>
std::pair<index, side_key<D>> make_side_key(std::array<index, D> v, index side)
{
    bool odd = false;
    const auto order = [&](std::size_t i, std::size_t j)
    {
        if (v[i] > v[j])
        {
            std::swap(v[i], v[j]);
            odd = !odd;
        }
    };
    order(0, 1);
    if constexpr (D == 3)
    {
        order(1, 2);
        order(0, 1);
    }
    side_key<D> key;
    for (std::size_t k = 1; k < D; ++k) key.rest[k - 1] = v[k];
    key.tag = 2 * static_cast<std::uint32_t>(side) + (odd ? 1u : 0u);
    return {v[0], key};
}

/// Links the sides [first, last) of one facet.
template <int D>
void link(facet_table& f, const side_key<D>* first, const side_key<D>* last)
{
    if (last - first == 2)
    {
        const index a = first[0].side(), b = first[1].side();
        f.twin[static_cast<std::size_t>(a)] = b;
        f.twin[static_cast<std::size_t>(b)] = a;
        if (((first[0].tag ^ first[1].tag) & 1u) == 0) f.clash.push_back({a, b});
    }
    else if (last - first > 2)
    {
        f.crowds.emplace_back();
        for (auto k = first; k != last; ++k)
        {
            f.twin[static_cast<std::size_t>(k->side())] = facet_table::crowded;
            f.crowds.back().push_back(k->side());
        }
    }
}

} // namespace detail

/// Finds the two sides of every facet: a counting sort by smallest vertex, then a small sort in each bucket.
/// Time O(n log(largest valence)), memory O(n).
template <class Element>
facet_table facets(const mesh<Element>& m)
{
    constexpr int D = Element::dimension;
    using key = detail::side_key<D>;
    const index sides = m.cell_count() * Element::corners;

    std::vector<index> end(static_cast<std::size_t>(m.vertex_count()) + 1, 0);
    for (index s = 0; s < sides; ++s)
    {
        const auto v = side_vertices(m, s);
        ++end[static_cast<std::size_t>(*std::min_element(v.begin(), v.end())) + 1];
    }
    for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];

    // end[v] is the start of bucket v here and becomes its end while the bucket fills.
    std::vector<key> keys(static_cast<std::size_t>(sides));
    for (index s = 0; s < sides; ++s)
    {
        const auto [v, k] = detail::make_side_key<D>(side_vertices(m, s), s);
        keys[static_cast<std::size_t>(end[static_cast<std::size_t>(v)]++)] = k;
    }

    facet_table f;
    f.twin.assign(static_cast<std::size_t>(sides), facet_table::boundary);
    key* bucket = keys.data();
    for (std::size_t v = 0; v + 1 < end.size(); ++v)
    {
        key* const last = keys.data() + end[v];
        std::sort(bucket, last);
        for (const key* first = bucket; first != last;)
        {
            const key* next = first + 1;
            while (next != last && next->rest == first->rest) ++next;
            detail::link<D>(f, first, next);
            first = next;
        }
        bucket = last;
    }
    return f;
}

} // namespace taut
