// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/core/keyed_hash.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// Numbers points by their coordinates, in the order in which they are first met. Points are one if their coordinates
/// are equal bit for bit, where 0 and -0 count as the same.
class point_numbers
{
public:
    /// The number of a point, and whether it is met for the first time.
    std::pair<idx, bool> number(const vec3& p)
    {
        if (2 * (points_.size() + 1) > slots_.size()) grow();
        const auto key = taut::impl::bits_of(p);
        std::size_t slot = taut::impl::keyed_hash(key) & (slots_.size() - 1);
        for (; slots_[slot] >= 0; slot = (slot + 1) & (slots_.size() - 1))
            if (taut::impl::bits_of(points_[static_cast<std::size_t>(slots_[slot])]) == key)
                return {slots_[slot], false};
        slots_[slot] = static_cast<idx>(points_.size());
        points_.push_back(p);
        return {slots_[slot], true};
    }

    std::span<const vec3> points() const { return points_; } ///< by number

private:
    void grow()
    {
        slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), -1);
        for (std::size_t i = 0; i < points_.size(); ++i)
        {
            std::size_t slot = taut::impl::keyed_hash(taut::impl::bits_of(points_[i])) & (slots_.size() - 1);
            while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = static_cast<idx>(i);
        }
    }

    std::vector<vec3> points_;
    std::vector<idx> slots_; // a power of two, half of it free
};

} // namespace taut::io::impl
