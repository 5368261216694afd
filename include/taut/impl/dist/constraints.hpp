// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <taut/impl/core/fixed_marks.hpp>
#include <taut/impl/core/types.hpp>

namespace taut::dist
{

/// Pins and springs of vertices by the caller's ids, which any process may give: those of all
/// processes together hold. A coordinate may be pinned by several processes, to the same value.
///
///     taut::dist::constraints<taut::tetrahedron> c;
///     c.pin(12, {0, 0, 1}).pin(5, 2, 0.5).spring(40, {1, 0, 0}, 10.0);
template <class Element>
class constraints
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::uint8_t all = taut::impl::fixed_marks<D>::every;

    /// One of them; weight 0: a pin of the coordinates in `held`, else a spring.
    struct entry
    {
        std::int64_t id;
        vec<D> x;
        double weight;
        std::uint8_t held;
    };

    /// Pins a vertex to a position.
    constraints& pin(std::int64_t id, const vec<D>& x)
    {
        entries_.push_back({id, x, 0, all});
        return *this;
    }
    /// Pins coordinate k of a vertex, 0 to D - 1, alone.
    constraints& pin(std::int64_t id, int k, double value)
    {
        vec<D> x(0.0);
        if (k >= 0 && k < D) x[k] = value;
        entries_.push_back({id, x, 0, static_cast<std::uint8_t>(k >= 0 && k < D ? 1U << k : 0U)});
        return *this;
    }
    /// Adds a spring to a position: weight * |x - target|^2 is added to the mean energy. Weight > 0.
    constraints& spring(std::int64_t id, const vec<D>& x, double weight)
    {
        entries_.push_back({id, x, weight, 0});
        return *this;
    }

    bool empty() const { return entries_.empty(); }

    /// Those of this process, as they were given.
    const std::vector<entry>& entries() const { return entries_; }

private:
    std::vector<entry> entries_;
};

} // namespace taut::dist
