// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/core/hierarchy/collapse.hpp>

namespace taut::impl
{

/// Order in which vertices are removed: small keys first. never: not in this round.
struct removal_key
{
    static constexpr std::uint32_t never = 0xffffffffU;
};

/// Scrambles the bits of a number, one to one.
inline std::uint32_t scramble(std::uint32_t x)
{
    x = (x ^ (x >> 16U)) * 0x7feb352dU;
    x = (x ^ (x >> 15U)) * 0x846ca68bU;
    return x ^ (x >> 16U);
}

/// Key of a vertex: dense regions and low valences first, by coarse classes; pseudo-random within a class, since any
/// fixed pattern would show in the coarse triangles.
///
/// size: of its star, relative to the mean;  salt: another one each round
inline std::uint32_t make_key(idx v, std::size_t valence, float size, std::uint32_t salt)
{
    // The exponent of the size: a class is a factor of two in area.
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(std::max(size, 1e-30F)) >> 23U) - 127;
    const int crowd = valence <= 6 ? 0 : static_cast<int>(valence) - 6;
    const auto group = static_cast<std::uint32_t>(std::clamp(exponent + 10 + crowd, 0, 30));
    return group << 27U | scramble(static_cast<std::uint32_t>(v) ^ salt) >> 5U;
}

/// Twice the area of the triangles around a vertex. (Not the lengths of its edges: needles must count as small, or
/// they would be kept.)
inline float star_size(const thinning_surface& m, idx v, std::span<const idx> ring)
{
    const vec3 p = m.points[static_cast<std::size_t>(v)];
    const vec3 last = m.points[static_cast<std::size_t>(ring.back())] - p;
    vec3 before = m.open[static_cast<std::size_t>(v)] ? vec3(0.0) : last;
    double sum = 0;
    for (const idx w : ring)
    {
        const vec3 e = m.points[static_cast<std::size_t>(w)] - p;
        sum += glm::length(glm::cross(before, e));
        before = e;
    }
    return static_cast<float>(sum);
}

/// Chooses the vertices of a round.
class independent_set
{
public:
    /// Chooses vertices with keys, no two of them neighbours, nearly as many as possible, the small keys first
    /// (Luby 1986: who has the smallest key among its undecided neighbours goes in). Independent of `threads`.
    ///
    /// alive: the vertices, ascending; the result is ascending too
    const std::vector<idx>& choose(const thinning_surface& m, std::span<const idx> alive,
                                   std::span<const std::uint32_t> key, unsigned threads)
    {
        key_.resize(key.size());
        in_.resize(key.size());
        undecided_.clear();
        for (const idx v : alive)
        {
            const auto i = static_cast<std::size_t>(v);
            key_[i] = key[i];
            in_[i] = 0;
            if (key[i] != removal_key::never) undecided_.push_back(v);
        }
        // Each sweep decides two vertices in three; what four leave undecided can wait for the next round.
        for (int sweep = 0; sweep < 4 && !undecided_.empty(); ++sweep) decide(m, threads);
        chosen_.clear();
        for (const idx v : alive)
            if (in_[static_cast<std::size_t>(v)]) chosen_.push_back(v);
        return chosen_;
    }

private:
    /// Runs two passes, each of which writes only what the other reads.
    void decide(const thinning_surface& m, unsigned threads)
    {
        const auto each = [&](auto&& body)
        {
            parallel_for(
                undecided_.size(),
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t i = begin; i < end; ++i) body(undecided_[i]);
                },
                threads);
        };
        each(
            [&](idx v)
            {
                const std::uint32_t mine = key_[static_cast<std::size_t>(v)];
                bool least = true;
                for (const idx w : m.rings[v])
                {
                    const std::uint32_t other = key_[static_cast<std::size_t>(w)];
                    least = least && (mine < other || (mine == other && v < w));
                }
                in_[static_cast<std::size_t>(v)] = least;
            });
        each(
            [&](idx v)
            {
                bool decided = in_[static_cast<std::size_t>(v)] != 0;
                for (const idx w : m.rings[v]) decided = decided || in_[static_cast<std::size_t>(w)];
                if (decided) key_[static_cast<std::size_t>(v)] = removal_key::never;
            });
        std::erase_if(undecided_, [&](idx v) { return key_[static_cast<std::size_t>(v)] == removal_key::never; });
    }

    std::vector<std::uint32_t> key_; // of the undecided; never: decided
    std::vector<char> in_;
    std::vector<idx> undecided_, chosen_;
};

} // namespace taut::impl
