// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/types.hpp>

namespace taut::io::detail
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
        const key_type key = key_of(p);
        std::size_t slot = slot_of(key);
        for (; slots_[slot] >= 0; slot = (slot + 1) & (slots_.size() - 1))
            if (key_of(points_[static_cast<std::size_t>(slots_[slot])]) == key) return {slots_[slot], false};
        slots_[slot] = static_cast<idx>(points_.size());
        points_.push_back(p);
        return {slots_[slot], true};
    }

    std::span<const vec3> points() const { return points_; } ///< by number

private:
    using key_type = std::array<std::uint64_t, 3>;

    static key_type key_of(const vec3& p)
    {
        const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x); };
        return {bits(p.x), bits(p.y), bits(p.z)};
    }

    std::size_t slot_of(const key_type& key) const
    {
        std::uint64_t h = 0;
        for (const std::uint64_t k : key)
        {
            h = (h ^ k) * 0x9e3779b97f4a7c15u; // the golden ratio spreads the bits
            h ^= h >> 29;
        }
        return static_cast<std::size_t>(h) & (slots_.size() - 1);
    }

    void grow()
    {
        slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), -1);
        for (std::size_t i = 0; i < points_.size(); ++i)
        {
            std::size_t slot = slot_of(key_of(points_[i]));
            while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = static_cast<idx>(i);
        }
    }

    std::vector<vec3> points_;
    std::vector<idx> slots_; // a power of two, half of it free
};

} // namespace taut::io::detail
