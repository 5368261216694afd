// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// The cells around one vertex, as the edges of its link.
class vertex_link
{
public:
    void add(idx from, idx to) { edges_.push_back({from, to}); }

    /// Closed loops that the edges form; 0 if one of them does not close: the vertex lies on a boundary, or the surface
    /// is no manifold there.
    std::size_t loops();

private:
    /// The one edge that begins where e ends, or their number if there is none or more than one.
    std::size_t after(std::size_t e) const
    {
        const idx v = edges_[e].second;
        const auto next =
            std::partition_point(edges_.begin(), edges_.end(), [v](const auto& edge) { return edge.first < v; });
        const bool single =
            next != edges_.end() && next->first == v && (next + 1 == edges_.end() || next[1].first != v);
        return single ? static_cast<std::size_t>(next - edges_.begin()) : edges_.size();
    }

    std::vector<std::pair<idx, idx>> edges_;
};

} // namespace taut::impl
