// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace taut::io::impl
{

/// From the numbers that a file gives its points to their positions, counted from 0.
class numbering
{
public:
    void add(long long id) { ids_.push_back(id); }

    /// Called once all are there. An id that two points have, if any.
    std::optional<long long> finish()
    {
        for (std::size_t v = 1; v < ids_.size() && consecutive_; ++v)
            consecutive_ = ids_[v - 1] < ids_[v] && ids_[v - 1] + 1 == ids_[v];
        if (consecutive_) return std::nullopt;
        for (std::size_t v = 0; v < ids_.size(); ++v) sorted_.emplace_back(ids_[v], static_cast<idx>(v));
        std::sort(sorted_.begin(), sorted_.end());
        const auto same = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                             [](const auto& a, const auto& b) { return a.first == b.first; });
        if (same != sorted_.end()) return same->first;
        return std::nullopt;
    }

    /// Nothing if no point has the number.
    std::optional<idx> find(long long id) const
    {
        if (ids_.empty()) return std::nullopt;
        if (consecutive_)
        {
            if (id < ids_.front() || id > ids_.back()) return std::nullopt;
            return static_cast<idx>(id - ids_.front());
        }
        const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(id, idx(0)));
        if (found == sorted_.end() || found->first != id) return std::nullopt;
        return found->second;
    }

private:
    std::vector<long long> ids_;
    bool consecutive_ = true;
    std::vector<std::pair<long long, idx>> sorted_; ///< unless consecutive
};

} // namespace taut::io::impl
