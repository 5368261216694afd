// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Table of facets (edges of triangles, faces of tetrahedra) with their two sides. Side s = corners * cell + k is the
/// facet of `cell` opposite its corner k.
struct facet_table
{
    static constexpr idx boundary = -1;     ///< the side has no other side
    static constexpr idx non_manifold = -2; ///< three or more cells share the facet

    std::vector<idx> twin;                 ///< other side of each side, or boundary, or non_manifold
    std::vector<std::array<idx, 2>> clash; ///< pairs of sides that run the same way: one cell is flipped
    std::vector<std::vector<idx>> crowds;  ///< the sides of each facet with three or more

    bool manifold() const { return crowds.empty(); }                  ///< at most two cells per facet
    bool oriented() const { return crowds.empty() && clash.empty(); } ///< and neighbours agree
};

/// The vertices of a side, oriented as the boundary of its cell.
template <class Element>
std::array<idx, Element::dimension> side_vertices(const mesh<Element>& m, idx side)
{
    const auto& t = m.cells()[static_cast<std::size_t>(side / Element::corners)];
    const auto& local = Element::facets[static_cast<std::size_t>(side % Element::corners)];
    std::array<idx, Element::dimension> v;
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = t[static_cast<std::size_t>(local[k])];
    return v;
}

/// A side in the bucket of its smallest vertex: its other vertices in increasing order, then its number and direction.
template <int D>
struct side_key
{
    std::array<idx, D - 1> rest;
    std::uint32_t tag; // 2 * side + (the vertices are an odd permutation of the sorted ones)

    idx side() const { return static_cast<idx>(tag >> 1); }
    bool operator<(const side_key& o) const
    {
        // Not by the operators of std::array, which call a function to compare one or two numbers.
        for (std::size_t k = 0; k < rest.size(); ++k)
            if (rest[k] != o.rest[k]) return rest[k] < o.rest[k];
        return tag < o.tag;
    }
    bool same_facet(const side_key& o) const
    {
        bool same = true;
        for (std::size_t k = 0; k < rest.size(); ++k) same &= rest[k] == o.rest[k];
        return same;
    }
};

/// The key of a side: sorts its vertices and leaves out the smallest.
template <int D>
side_key<D> make_side_key(std::array<idx, D> v, idx side)
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
    return key;
}

/// Links the sides [first, last) of one facet. Returns false if the facet is faulty.
template <int D>
bool link(std::vector<idx>& twin, const side_key<D>* first, const side_key<D>* last)
{
    if (last - first == 1) return true;
    const bool non_manifold = last - first > 2;
    for (auto k = first; k != last; ++k)
        twin[static_cast<std::size_t>(k->side())] =
            non_manifold ? facet_table::non_manifold : first[k == first ? 1 : 0].side();
    return !non_manifold && ((first[0].tag ^ first[1].tag) & 1u) != 0;
}

/// Notes what is wrong with the facet of the sides [first, last).
template <int D>
void note_fault(facet_table& f, const side_key<D>* first, const side_key<D>* last)
{
    if (last - first == 2 && ((first[0].tag ^ first[1].tag) & 1u) == 0)
        f.clash.push_back({first[0].side(), first[1].side()});
    if (last - first <= 2) return;
    f.crowds.emplace_back();
    for (auto k = first; k != last; ++k) f.crowds.back().push_back(k->side());
}

/// Calls facet(first, last) for the sides of each facet among sorted ones.
template <int D, class Facet>
void for_each_facet(const side_key<D>* first, const side_key<D>* last, const Facet& facet)
{
    while (first != last)
    {
        const side_key<D>* next = first + 1;
        while (next != last && next->same_facet(*first)) ++next;
        facet(first, next);
        first = next;
    }
}

/// Sorts a few keys in place: buckets are as long as a vertex has sides of which it is the smallest.
template <int D>
void sort_bucket(side_key<D>* first, side_key<D>* last)
{
    if (last - first > 16) return std::sort(first, last);
    for (auto k = first; k != last; ++k)
    {
        const side_key<D> key = *k;
        auto at = k;
        for (; at != first && key < at[-1]; --at) *at = at[-1];
        *at = key;
    }
}

/// Computes the facet table of a mesh: a counting sort by smallest vertex, then a small sort in each bucket.
/// Time O(n log(largest valence)), memory O(n).
template <class Element>
facet_table facets(const mesh<Element>& m)
{
    constexpr int D = Element::dimension;
    using key = impl::side_key<D>;
    const std::size_t sides = m.cells().size() * static_cast<std::size_t>(Element::corners);
    const auto smallest = [&](std::size_t s)
    {
        const auto v = impl::side_vertices(m, static_cast<idx>(s));
        return *std::min_element(v.begin(), v.end());
    };
    std::vector<key> keys(sides);
    const auto start = impl::counting_sort(
        sides, m.points().size(), smallest,
        [&](std::size_t s, std::size_t position)
        { keys[position] = impl::make_side_key<D>(impl::side_vertices(m, static_cast<idx>(s)), static_cast<idx>(s)); });

    facet_table f;
    f.twin.assign(sides, facet_table::boundary);
    std::atomic<bool> faulty{false};
    impl::parallel_for(m.points().size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t v = begin; v < end; ++v)
                           {
                               key *const first = keys.data() + start[v], *const last = keys.data() + start[v + 1];
                               impl::sort_bucket<D>(first, last);
                               impl::for_each_facet<D>(first, last,
                                                       [&](const key* a, const key* b)
                                                       {
                                                           if (!impl::link<D>(f.twin, a, b)) faulty = true;
                                                       });
                           }
                       });
    if (!faulty) return f;
    for (std::size_t v = 0; v < m.points().size(); ++v)
        impl::for_each_facet<D>(keys.data() + start[v], keys.data() + start[v + 1],
                                [&](const key* a, const key* b) { impl::note_fault<D>(f, a, b); });
    return f;
}

// Compiled once, with the bodies.
extern template facet_table facets(const mesh<triangle>&);
extern template facet_table facets(const mesh<tetrahedron>&);

} // namespace taut::impl
