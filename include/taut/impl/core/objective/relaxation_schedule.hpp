// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/mesh/layout.hpp>

namespace taut::impl
{

/// Colouring of vertices such that no two of a colour share an element: those can move at once. A row is a vertex, an
/// entry is an element at it; a colour is a run of rows and the run of their entries.
struct relaxation_schedule
{
    struct colour
    {
        idx first_row = 0, rows = 0;
        idx first_entry = 0, entries = 0;
    };
    std::vector<colour> colours;

    /// Four lists, `stride` apart: the vertex of each row; the first entry of each row, and one more; the cell of each
    /// entry; the row of each entry.
    std::vector<idx> lists;
    idx stride = 0;
    idx rows = 0;
    idx widest = 0; ///< the most entries of one colour
};

/// Finds the schedule of the free vertices of some cells of a layout, in time that grows with those only.
template <class Element>
class relaxation_scheduler
{
public:
    /// still: one flag per vertex in the user's numbers, or none; these stay out like those that are pinned.
    explicit relaxation_scheduler(const layout<Element>& mesh_layout, const std::vector<bool>& still = {})
        : colour_(static_cast<std::size_t>(mesh_layout.free_count), unlisted)
    {
        if (still.empty()) return;
        for (std::size_t v = 0; v < colour_.size(); ++v)
            if (still[at(mesh_layout.order.vertices.new_to_old[v])]) colour_[v] = barred;
    }

    /// Computes a greedy colouring in the order of the vertices.
    relaxation_schedule operator()(const layout<Element>& mesh_layout, std::span<const idx> cells)
    {
        const auto vertices = free_vertices(mesh_layout, cells);
        const auto count = paint(mesh_layout, vertices);
        relaxation_schedule result = arrange(mesh_layout.vertex_corners, vertices, count);
        for (const idx v : vertices) colour_[at(v)] = unlisted;
        return result;
    }

private:
    static constexpr idx unlisted = -1, listed = -2, barred = -3;
    static std::size_t at(idx i) { return static_cast<std::size_t>(i); }

    std::vector<idx> free_vertices(const layout<Element>& mesh_layout, std::span<const idx> cells)
    {
        std::vector<idx> vertices;
        for (const idx c : cells)
            for (std::size_t k = 0; k < Element::corners; ++k)
            {
                const idx v = mesh_layout.corners[k * mesh_layout.cell_stride + at(c)];
                if (v >= mesh_layout.free_count || colour_[at(v)] != unlisted) continue;
                colour_[at(v)] = listed;
                vertices.push_back(v);
            }
        std::sort(vertices.begin(), vertices.end());
        return vertices;
    }

    /// Returns the number of colours.
    std::size_t paint(const layout<Element>& mesh_layout, std::span<const idx> vertices)
    {
        std::vector<idx> taken_by; // by colour: the last vertex that found it at a neighbour
        for (const idx v : vertices)
        {
            for (const idx corner : mesh_layout.vertex_corners.row(v))
                for (std::size_t k = 0; k < Element::corners; ++k)
                {
                    const idx w = mesh_layout.corners[k * mesh_layout.cell_stride + at(corner / Element::corners)];
                    if (w < mesh_layout.free_count && colour_[at(w)] >= 0) taken_by[at(colour_[at(w)])] = v;
                }
            const auto free = std::find_if(taken_by.begin(), taken_by.end(), [&](idx by) { return by != v; });
            colour_[at(v)] = static_cast<idx>(free - taken_by.begin());
            if (free == taken_by.end()) taken_by.push_back(-1);
        }
        return taken_by.size();
    }

    relaxation_schedule arrange(const csr& vertex_corners, std::span<const idx> vertices, std::size_t count) const
    {
        relaxation_schedule r;
        r.colours.resize(count);
        r.rows = static_cast<idx>(vertices.size());
        idx entries = 0;
        for (const idx v : vertices)
        {
            auto& c = r.colours[at(colour_[at(v)])];
            const auto valence = static_cast<idx>(vertex_corners.row(v).size());
            ++c.rows;
            c.entries += valence;
            entries += valence;
        }
        for (std::size_t k = 0; k < count; ++k)
        {
            r.widest = std::max(r.widest, r.colours[k].entries);
            if (k == 0) continue;
            r.colours[k].first_row = r.colours[k - 1].first_row + r.colours[k - 1].rows;
            r.colours[k].first_entry = r.colours[k - 1].first_entry + r.colours[k - 1].entries;
        }

        r.stride = std::max(entries, r.rows + 1);
        r.lists.assign(4 * at(r.stride), 0);
        const auto list = [&](int which) { return r.lists.begin() + static_cast<std::ptrdiff_t>(which) * r.stride; };
        auto next = r.colours; // where each colour goes on
        for (const idx v : vertices)
        {
            auto& n = next[at(colour_[at(v)])];
            list(0)[n.first_row] = v;
            list(1)[n.first_row] = n.first_entry;
            for (const idx corner : vertex_corners.row(v))
            {
                list(2)[n.first_entry] = corner / Element::corners;
                list(3)[n.first_entry++] = n.first_row;
            }
            ++n.first_row;
        }
        list(1)[r.rows] = entries;
        return r;
    }

    std::vector<idx> colour_; ///< by free vertex; all unlisted between two calls
};

} // namespace taut::impl
