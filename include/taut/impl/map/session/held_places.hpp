// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/core/fixed_marks.hpp>
#include <taut/impl/core/linalg.hpp>

namespace taut::impl
{

/// Fixed vertices of a session and their targets: pins, and the vertices of a fixed boundary. Lengths are those of the
/// map.
template <class Element>
class held_places
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    held_places() = default; ///< of no map
    /// fixed: vertices that keep their positions in `start`, unless they are pinned. slides: relative to it.
    held_places(const map& start, std::vector<idx> fixed, std::vector<slide<D>> slides = {})
        : start_(start), places_(start), fixed_(std::move(fixed)), slides_(std::move(slides))
    {
    }

    /// Replaces the pins; returns whether the set of fixed coordinates has changed.
    bool take(const constraints<Element>& wanted)
    {
        fixed_marks<D> marks(places_.size());
        for (const idx v : fixed_)
        {
            marks[static_cast<std::size_t>(v)] = marks.every;
            places_[static_cast<std::size_t>(v)] = start_[static_cast<std::size_t>(v)];
        }
        for (const auto& [v, pin] : wanted.pins())
        {
            marks[static_cast<std::size_t>(v)] |= pin.held;
            for (int k = 0; k < D; ++k)
                if ((pin.held >> k & 1u) != 0) places_[static_cast<std::size_t>(v)][k] = pin.value[k];
        }
        if (marks == marks_) return false;
        marks_ = std::move(marks);
        return true;
    }

    const fixed_marks<D>& marks() const { return marks_; }
    const std::vector<slide<D>>& slides() const { return slides_; }
    const map& places() const { return places_; } ///< of fixed coordinates; the others mean nothing

    struct farthest
    {
        idx vertex = -1; ///< -1: all are at their places
        double distance = 0;
    };

    /// Finds the vertex whose fixed coordinates are farthest from their targets in a map.
    farthest gap(const map& x) const { return gap(x, places_); }

    /// The same relative to their positions in another map.
    farthest gap(const map& x, const map& places) const
    {
        farthest f;
        for (std::size_t v = 0; v < marks_.size(); ++v)
        {
            if (!marks_.any(v)) continue;
            vec<D> d(0.0);
            for (int k = 0; k < D; ++k)
                if (marks_.test(v, k)) d[k] = places[v][k] - x[v][k];
            if (const double length = glm::length(d); length > f.distance) f = {static_cast<idx>(v), length};
        }
        return f;
    }

    /// Sets fixed coordinates to their targets.
    void impose(map& x) const { impose(x, x); }

    /// The same where they are as in `rounded`, the targets after rounding.
    void impose(map& x, const map& rounded) const
    {
        for (std::size_t v = 0; v < marks_.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (marks_.test(v, k) && x[v][k] == rounded[v][k]) x[v][k] = places_[v][k];
        for (const auto& s : slides_) // which drift by roundings
        {
            const auto v = static_cast<std::size_t>(s.vertex);
            x[v] = start_[v] + s.projection * (x[v] - start_[v]);
        }
    }

private:
    map start_, places_;
    std::vector<idx> fixed_;
    std::vector<slide<D>> slides_;
    fixed_marks<D> marks_;
};

} // namespace taut::impl
