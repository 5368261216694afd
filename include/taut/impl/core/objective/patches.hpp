// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/layout.hpp>

namespace taut::impl
{

/// Parameters of the patches of a map.
struct patch_params
{
    double share = 0.9;    ///< maximum fraction of all weights that the vertices in the middle of patches have
    double middles = 0.01; ///< maximum fraction of the free vertices that are middles
    int rings = 8;         ///< around them
    double size = 0.2;     ///< maximum fraction of the free vertices in patches
    std::size_t most_vertices = 8192; ///< that patches have at most
};

/// Part of a mesh in its own numbering: connected free vertices, and all cells at them.
template <class Element>
struct patch
{
    std::vector<typename mesh<Element>::cell> cells;
    std::vector<idx> cell_ids; ///< their numbers in the layout
    std::vector<idx> vertices; ///< the numbers of its vertices there
    std::vector<char> fixed;   ///< one per vertex: it does not move
};

/// Finds the patches around the vertices of the largest weights.
template <class Element>
class patch_finder
{
public:
    /// weights: one per free vertex of the layout, not negative; barred: flags of those that no patch moves.
    patch_finder(const layout<Element>& mesh_layout, std::span<const double> weights, const std::vector<char>& barred,
                 const patch_params& params = {})
        : layout_(mesh_layout),
          barred_(barred),
          params_(params),
          state_(at(mesh_layout.vertex_count), outside),
          local_(at(mesh_layout.vertex_count), -1),
          listed_(at(mesh_layout.cell_count), 0)
    {
        const auto middles = heaviest(weights);
        // Fewer where their rings are more than patches may have.
        for (std::size_t count = middles.size(); count > 0; count /= 2)
            if (grow(std::span(middles).first(count))) break;
    }

    /// Patches found, the largest first.
    std::vector<patch<Element>> patches()
    {
        std::vector<patch<Element>> all;
        for (const idx v : inside_)
            if (state_[at(v)] == inside) all.push_back(gathered(v));
        std::stable_sort(all.begin(), all.end(),
                         [](const auto& a, const auto& b) { return a.cells.size() > b.cells.size(); });
        return all;
    }

private:
    static constexpr char outside = 0, inside = 1, taken = 2;
    static std::size_t at(idx i) { return static_cast<std::size_t>(i); }

    idx corner(idx cell, std::size_t k) const { return layout_.corners[k * layout_.cell_stride + at(cell)]; }
    bool moves(idx v) const { return v < layout_.free_count && !barred_[at(v)]; }

    template <class Visit>
    void each_neighbour(idx v, const Visit& visit) const
    {
        for (const idx c : layout_.vertex_corners.row(v))
            for (std::size_t k = 0; k < Element::corners; ++k)
                if (const idx w = corner(c / Element::corners, k); moves(w)) visit(w);
    }

    std::vector<idx> heaviest(std::span<const double> weights) const
    {
        std::vector<idx> order;
        double total = 0;
        for (idx v = 0; v < layout_.free_count; ++v)
        {
            if (!moves(v) || !(weights[at(v)] > 0)) continue;
            order.push_back(v);
            total += weights[at(v)];
        }
        const double limit = params_.middles * double(layout_.free_count);
        const auto most = std::min(order.size(), static_cast<std::size_t>(limit));
        std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(),
                          [&](idx a, idx b) { return std::pair(-weights[at(a)], a) < std::pair(-weights[at(b)], b); });
        std::size_t count = 0;
        for (double sum = 0; count < most && sum < params_.share * total; ++count) sum += weights[at(order[count])];
        order.resize(count);
        return order;
    }

    /// Grows patches around these centres; returns false, with none, where they would be too large.
    bool grow(std::span<const idx> middles)
    {
        const auto most =
            std::min(static_cast<std::size_t>(params_.size * double(layout_.free_count)), params_.most_vertices);
        inside_.assign(middles.begin(), middles.end());
        for (const idx v : inside_) state_[at(v)] = inside;
        std::size_t first = 0;
        for (int ring = 0; ring < params_.rings && inside_.size() <= most; ++ring)
        {
            const std::size_t last = inside_.size();
            for (; first < last && inside_.size() <= most; ++first)
                each_neighbour(inside_[first],
                               [&](idx w)
                               {
                                   if (state_[at(w)] != outside) return;
                                   state_[at(w)] = inside;
                                   inside_.push_back(w);
                               });
        }
        if (inside_.size() <= most) return true;
        for (const idx v : inside_) state_[at(v)] = outside;
        inside_.clear();
        return false;
    }

    /// The patch of a vertex.
    patch<Element> gathered(idx from)
    {
        std::vector<idx> members{from};
        state_[at(from)] = taken;
        patch<Element> p;
        for (std::size_t i = 0; i < members.size(); ++i)
        {
            for (const idx corner : layout_.vertex_corners.row(members[i]))
                if (const idx c = corner / Element::corners; !listed_[at(c)])
                {
                    listed_[at(c)] = 1;
                    p.cell_ids.push_back(c);
                }
            each_neighbour(members[i],
                           [&](idx w)
                           {
                               if (state_[at(w)] != inside) return;
                               state_[at(w)] = taken;
                               members.push_back(w);
                           });
        }
        std::sort(p.cell_ids.begin(), p.cell_ids.end());
        for (const idx c : p.cell_ids)
            for (std::size_t k = 0; k < Element::corners; ++k)
                if (const idx v = corner(c, k); local_[at(v)] < 0)
                {
                    local_[at(v)] = 0;
                    p.vertices.push_back(v);
                }
        std::sort(p.vertices.begin(), p.vertices.end());
        for (std::size_t i = 0; i < p.vertices.size(); ++i) local_[at(p.vertices[i])] = static_cast<idx>(i);
        // What moves and is not of this patch has no cell in common with it.
        for (const idx v : p.vertices) p.fixed.push_back(state_[at(v)] != taken);
        for (const idx c : p.cell_ids)
        {
            auto& cell = p.cells.emplace_back();
            for (std::size_t k = 0; k < Element::corners; ++k) cell[k] = local_[at(corner(c, k))];
        }
        for (const idx v : p.vertices) local_[at(v)] = -1;
        return p;
    }

    const layout<Element>& layout_;
    const std::vector<char>& barred_;
    patch_params params_;
    std::vector<char> state_;  // by vertex
    std::vector<idx> local_;   // by vertex: its number in the patch that is gathered, or -1
    std::vector<char> listed_; // by cell: a patch has it
    std::vector<idx> inside_;  // vertices of patches
};

} // namespace taut::impl
