// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace taut::impl
{

/// Flags of fixed coordinates: one byte per vertex, whose bit k says that coordinate k is fixed.
template <int D>
class fixed_marks
{
public:
    static constexpr std::uint8_t every = (1u << D) - 1; ///< all coordinates of a vertex

    fixed_marks() = default; ///< flags of no vertex
    explicit fixed_marks(std::size_t vertices) : bits_(vertices, 0) {}
    explicit fixed_marks(std::vector<std::uint8_t> bits) : bits_(std::move(bits)) {} ///< one per vertex

    std::size_t size() const noexcept { return bits_.size(); } ///< vertices
    bool empty() const noexcept { return bits_.empty(); }

    std::uint8_t operator[](std::size_t v) const { return bits_[v]; }
    std::uint8_t& operator[](std::size_t v) { return bits_[v]; }
    const std::vector<std::uint8_t>& bits() const noexcept { return bits_; }

    bool test(std::size_t v, int k) const { return (bits_[v] >> k & 1u) != 0; }
    bool all(std::size_t v) const { return bits_[v] == every; } ///< the vertex is pinned
    bool any(std::size_t v) const { return bits_[v] != 0; }
    bool any() const
    {
        return std::any_of(bits_.begin(), bits_.end(), [](std::uint8_t b) { return b != 0; });
    }

    /// Pinned vertices.
    std::size_t count() const { return static_cast<std::size_t>(std::count(bits_.begin(), bits_.end(), every)); }

    /// One flag per vertex: it is pinned.
    std::vector<bool> pinned() const
    {
        std::vector<bool> flags(bits_.size());
        for (std::size_t v = 0; v < flags.size(); ++v) flags[v] = all(v);
        return flags;
    }

    /// The same without those of pinned vertices.
    fixed_marks without_pinned() const
    {
        fixed_marks rest = *this;
        std::replace(rest.bits_.begin(), rest.bits_.end(), every, std::uint8_t(0));
        return rest;
    }

    friend bool operator==(const fixed_marks&, const fixed_marks&) = default;

private:
    std::vector<std::uint8_t> bits_;
};

} // namespace taut::impl
