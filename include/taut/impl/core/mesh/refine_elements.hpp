// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Stellar subdivisions, one after the other: a new vertex in the middle of an edge, a face or a cell, and each simplex
/// that has it as a part becomes as many as that has vertices, each with the new vertex in place of one of them. All
/// simplices of a mesh that are subdivided alike still meet in whole faces, and those of positive measure have parts of
/// positive and equal measure.
class subdivision
{
public:
    subdivision() = default; ///< subdivision of no mesh

    /// Makes an empty subdivision of a mesh with a number of vertices.
    explicit subdivision(idx vertices) : originals_(vertices) {}

    /// Inserts a vertex at the centre of a simplex, of 2 to 4 vertices in any order: of the mesh, or inserted before.
    /// Returns its number: new ones follow the others in the order of insertion; the same simplex twice has one. A
    /// simplex with a part that was split before no longer exists: split cells first, then faces, then edges. Throws
    /// parameter_error for another number of vertices, a missing or a repeated one.
    idx split(std::vector<idx> simplex)
    {
        std::sort(simplex.begin(), simplex.end());
        if (simplex.size() < 2 || simplex.size() > 4 || simplex.front() < 0 || simplex.back() >= vertex_count() ||
            std::adjacent_find(simplex.begin(), simplex.end()) != simplex.end())
            throw parameter_error("simplex", "needs 2 to 4 different vertices of the " +
                                                 std::to_string(vertex_count()) + " that there are");
        if (vertex_count() == std::numeric_limits<idx>::max())
            throw parameter_error("simplex", "has no number left for its middle; split the mesh");
        auto& here = of_first_[simplex.front()];
        for (const idx s : here)
            if (middles_[static_cast<std::size_t>(s)] == simplex) return originals_ + s;
        here.push_back(static_cast<idx>(middles_.size()));
        middles_.push_back(std::move(simplex));
        return vertex_count() - 1;
    }

    bool empty() const noexcept { return middles_.empty(); }
    idx original_count() const noexcept { return originals_; } ///< vertices of the mesh
    idx vertex_count() const noexcept { return originals_ + static_cast<idx>(middles_.size()); }

    /// The simplices in whose middles the new vertices are, vertices ascending.
    const std::vector<std::vector<idx>>& middles() const noexcept { return middles_; }

    /// Values at all vertices, positions for instance: those of the mesh as they are, then means.
    template <class T>
    std::vector<T> extended(std::span<const T> values) const
    {
        std::vector<T> all(values.begin(), values.end());
        all.reserve(static_cast<std::size_t>(vertex_count()));
        for (const auto& simplex : middles_)
        {
            T sum = all[static_cast<std::size_t>(simplex[0])];
            for (std::size_t k = 1; k < simplex.size(); ++k) sum += all[static_cast<std::size_t>(simplex[k])];
            all.push_back(sum / static_cast<double>(simplex.size()));
        }
        return all;
    }

    /// Calls part(array of vertices) for the parts of a simplex of the mesh, orientation kept.
    template <std::size_t N, class Part>
    void for_each_part(const std::array<idx, N>& simplex, const Part& part) const
    {
        divide(simplex, 0, part);
    }

private:
    template <std::size_t N, class Part>
    void divide(const std::array<idx, N>& simplex, idx from, const Part& part) const
    {
        constexpr idx none = std::numeric_limits<idx>::max();
        const auto has = [&](idx v) { return std::find(simplex.begin(), simplex.end(), v) != simplex.end(); };
        idx first = none;
        for (const idx v : simplex)
            if (const auto splits = of_first_.find(v); splits != of_first_.end())
                for (const idx s : splits->second)
                {
                    const auto& middle = middles_[static_cast<std::size_t>(s)];
                    if (s >= from && s < first && std::all_of(middle.begin(), middle.end(), has)) first = s;
                }
        if (first == none) return part(simplex);
        for (const idx v : middles_[static_cast<std::size_t>(first)])
        {
            auto piece = simplex;
            *std::find(piece.begin(), piece.end(), v) = originals_ + first;
            divide(piece, first + 1, part);
        }
    }

    idx originals_ = 0;
    std::vector<std::vector<idx>> middles_;
    std::unordered_map<idx, std::vector<idx>> of_first_; ///< the splits of simplices whose smallest vertex this is
};

/// Refined mesh, with the parents of its elements.
template <class Element>
struct refinement
{
    mesh<Element> refined;  ///< the vertices of the mesh first, in their order; the parts of an element together
    std::vector<idx> cells; ///< element that contains each of its elements; ascending
};

/// Splits elements of a mesh at rest, those beside them, too, so that neighbours meet in whole facets.
/// Throws parameter_error for a subdivision of another number of vertices; mesh_error (too_large).
template <class Element>
refinement<Element> refine_elements(const mesh<Element>& m, const subdivision& how)
{
    if (how.original_count() != m.vertex_count())
        throw parameter_error("how", "is of " + std::to_string(how.original_count()) + " vertices, and the mesh has " +
                                         std::to_string(m.vertex_count()));
    std::vector<typename mesh<Element>::cell> cells;
    std::vector<idx> of;
    cells.reserve(m.cells().size());
    for (std::size_t c = 0; c < m.cells().size(); ++c)
        how.for_each_part(m.cells()[c],
                          [&](const auto& part)
                          {
                              cells.push_back(part);
                              of.push_back(static_cast<idx>(c));
                          });
    return {mesh<Element>(how.extended(std::span<const vec3>(m.points())), std::move(cells)), std::move(of)};
}

} // namespace taut::impl
