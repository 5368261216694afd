// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include <taut/io/volume_file.hpp>

namespace taut::io
{

/// A side of a volume cell, its normal pointing out where the cell is positive.
struct cell_face
{
    idx cell;                    ///< as for_each_cell() counts
    std::array<idx, 4> vertices; ///< around; the last is -1 in a triangle

    std::span<const idx> corners() const { return std::span<const idx>(vertices).first(vertices[3] < 0 ? 3 : 4); }
};

/// The sides of all volume cells, those of a cell together, and which meet.
struct cell_faces
{
    static constexpr idx boundary = -1; ///< no cell is on the other side
    static constexpr idx crowded = -2;  ///< three cells or more share the face

    std::vector<cell_face> faces;
    std::vector<idx> twin; ///< the other side of each, or boundary, or crowded
};

namespace detail
{

/// Corners of the sides of a cell, by VTK's numbers; -1 ends a triangle.
template <class = void>
std::span<const std::array<int, 4>> face_table(cell_kind kind)
{
    using face = std::array<int, 4>;
    static constexpr std::array<face, 4> tetrahedron = {{{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}}};
    static constexpr std::array<face, 5> pyramid = {
        {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
    static constexpr std::array<face, 5> wedge = {
        {{0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}};
    static constexpr std::array<face, 6> hexahedron = {
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
    switch (kind)
    {
    case cell_kind::tetrahedron:
        return tetrahedron;
    case cell_kind::pyramid:
        return pyramid;
    case cell_kind::wedge:
        return wedge;
    case cell_kind::hexahedron:
        return hexahedron;
    default:
        return {};
    }
}

} // namespace detail

/// Time O(n log n).
template <class = void>
cell_faces cell_faces_of(const volume_file& file)
{
    cell_faces result;
    std::vector<std::array<idx, 4>> keys;
    for_each_cell(file, 3,
                  [&](cell_kind kind, idx number, std::span<const idx> corners)
                  {
                      for (const auto& side : detail::face_table(kind))
                      {
                          auto& face = result.faces.emplace_back(cell_face{number, {-1, -1, -1, -1}});
                          for (std::size_t k = 0; k < 4; ++k)
                              if (side[k] >= 0) face.vertices[k] = corners[static_cast<std::size_t>(side[k])];
                          keys.push_back(face.vertices);
                          std::sort(keys.back().begin(), keys.back().end());
                      }
                  });
    std::vector<idx> order(keys.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](idx side) -> const auto&
    {
        return keys[static_cast<std::size_t>(side)];
    };
    std::sort(order.begin(), order.end(), [&](idx a, idx b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    result.twin.assign(keys.size(), cell_faces::boundary);
    for (std::size_t first = 0, last = 0; first < order.size(); first = last)
    {
        while (last < order.size() && key(order[last]) == key(order[first])) ++last;
        if (last - first == 1) continue;
        for (std::size_t k = first; k < last; ++k)
            result.twin[static_cast<std::size_t>(order[k])] =
                last - first > 2 ? cell_faces::crowded : order[k == first ? last - 1 : first];
    }
    return result;
}

} // namespace taut::io
