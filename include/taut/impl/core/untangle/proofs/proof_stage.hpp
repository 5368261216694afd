// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/untangle/proofs/crowded_edge.hpp>
#include <taut/impl/core/untangle/stage.hpp>

namespace taut::impl
{

/// Searches around the last few inverted elements for a proof that there is no map (proofs/crowded_edge.hpp).
class proof_stage final : public untangle_stage<tetrahedron>
{
public:
    std::string_view name() const override { return "proof"; }

    bool run(untangle_state<tetrahedron>& state, int) override
    {
        if (state.injective()) return false;
        if (impl::flat_sides(state.problem()).empty()) return false;
        if (state.flips().flipped > few) return true;
        auto cells = certify<3>(state.cells(), std::span<const vec3>(state.best_map()), {}, few).ids;
        std::erase_if(cells, [this](idx c) { return std::find(seen_.begin(), seen_.end(), c) != seen_.end(); });
        seen_.insert(seen_.end(), cells.begin(), cells.end());
        infeasibility found;
        impl::judge_edges(
            state.problem(), cells, [&state] { return state.proceed(0); }, found);
        if (!found) return true;
        state.disprove(std::move(found.proofs.front()));
        return false;
    }

private:
    static constexpr std::size_t few = 8;

    std::vector<idx> seen_; // elements that were looked at
};

} // namespace taut::impl
