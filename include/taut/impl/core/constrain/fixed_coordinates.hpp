// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Fixed coordinates of a map and their targets, in the lengths of the map: pins, vertices that keep their positions,
/// and directions in which vertices do not slide.
template <class Element>
class fixed_coordinates
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    fixed_coordinates() = default; ///< of no map

    /// still: vertices that keep their positions in `start`, unless they are pinned. slides: relative to it.
    fixed_coordinates(map start, std::vector<idx> still, std::vector<slide<D>> slides = {})
        : marks_(start.size()),
          targets_(start),
          start_(std::move(start)),
          still_(std::move(still)),
          slides_(std::move(slides))
    {
    }

    /// targets: one position per vertex, of which the fixed coordinates are read.
    fixed_coordinates(fixed_marks<D> marks, map targets) : marks_(std::move(marks)), targets_(std::move(targets)) {}

    /// Replaces the pins; returns whether the set of fixed coordinates has changed.
    bool take(const constraints<Element>& wanted)
    {
        fixed_marks<D> marks(targets_.size());
        for (const idx v : still_)
        {
            marks[static_cast<std::size_t>(v)] = marks.every;
            targets_[static_cast<std::size_t>(v)] = start_[static_cast<std::size_t>(v)];
        }
        for (const auto& [v, pin] : wanted.pins())
        {
            marks[static_cast<std::size_t>(v)] |= pin.held;
            for (int k = 0; k < D; ++k)
                if ((pin.held >> k & 1u) != 0) targets_[static_cast<std::size_t>(v)][k] = pin.value[k];
        }
        return std::exchange(marks_, std::move(marks)) != marks_;
    }

    /// Sets other targets of the same coordinates: one position per vertex, of which these are read.
    void redirect(map targets) { targets_ = std::move(targets); }

    const fixed_marks<D>& marks() const { return marks_; } ///< one per vertex
    const std::vector<slide<D>>& slides() const { return slides_; }
    const map& targets() const { return targets_; } ///< one per vertex; those of free coordinates mean nothing

    struct farthest
    {
        idx vertex = -1; ///< -1: all are at their targets
        double distance = 0;
    };

    /// Finds the vertex whose fixed coordinates are farthest from their targets in a map.
    farthest gap(const map& x) const
    {
        return gap(x, [this](std::size_t v) { return targets_[v]; });
    }

    /// The same for other targets, of which target(v) is that of vertex v.
    template <class Target>
    farthest gap(const map& x, const Target& target) const
    {
        farthest f;
        for (std::size_t v = 0; v < marks_.size(); ++v)
        {
            if (!marks_.any(v)) continue;
            const vec<D> to = target(v);
            vec<D> d(0.0);
            for (int k = 0; k < D; ++k)
                if (marks_.test(v, k)) d[k] = to[k] - x[v][k];
            if (const double length = glm::length(d); length > f.distance) f = {static_cast<idx>(v), length};
        }
        return f;
    }

    /// Sets fixed coordinates to their targets, and sliding vertices on their lines and planes.
    void impose(map& x) const
    {
        impose(x, [&x](std::size_t v) { return x[v]; });
    }

    /// The same without slides for a map whose lengths are `unit` times those of the targets.
    void impose_scaled(map& x, double unit) const
    {
        for (std::size_t v = 0; v < marks_.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (marks_.test(v, k)) x[v][k] = targets_[v][k] * unit;
    }

    /// The same for those fixed coordinates that are rounded(v), the target of vertex v after rounding.
    template <class Rounded>
    void impose(map& x, const Rounded& rounded) const
    {
        for (std::size_t v = 0; v < marks_.size(); ++v)
        {
            if (!marks_.any(v)) continue;
            const vec<D> there = rounded(v);
            for (int k = 0; k < D; ++k)
                if (marks_.test(v, k) && x[v][k] == there[k]) x[v][k] = targets_[v][k];
        }
        for (const auto& s : slides_) // which drift by roundings
        {
            const auto v = static_cast<std::size_t>(s.vertex);
            x[v] = start_[v] + s.projection * (x[v] - start_[v]);
        }
    }

private:
    fixed_marks<D> marks_;
    map targets_, start_;
    std::vector<idx> still_;
    std::vector<slide<D>> slides_;
};

} // namespace taut::impl
