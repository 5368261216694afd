// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/exact/mend_rounding.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/surface_file.hpp>

#include "shared/failure.hpp"
#include "shared/text_table.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// A shape as a file holds it: what io::impl::volume_outputs() writes, and what is true of that. Where the file has
/// single precision, coordinates are rounded, and free vertices move by units of their last digit where cells would be
/// flat.
template <class Element>
struct written_shape
{
    static constexpr int D = Element::dimension;

    std::vector<vec<D>> x;    ///< bit for bit as the file holds it
    std::vector<vec3> points; ///< the same, as points of the file
    volume_state state;       ///< of x, or of what readers make of it who round a text: the one with defects
    std::string note;         ///< on vertices that were moved; empty: none was

    /// movable(v, k): coordinate k of vertex v may differ from what it is.
    template <class Movable>
    written_shape(const volume_case<Element>& input, std::vector<vec<D>> from, const Movable& movable)
        : x(std::move(from))
    {
        const auto& places = input.file().places;
        if (places.rounds()) x = input.as_written(x);
        judge(input);
        if (places.single && !state.simplices) mend(input, movable);
        points = input.in_file(x);
    }

    /// Describes the defects, with the remedy; empty: none.
    std::string defects(const volume_case<Element>& input) const
    {
        if (state.simplices) return {};
        return "in the single precision of the file the mesh has " +
               impl::describe_defects<Element>(state.simplices, input.owners()) +
               "; save the input in double precision, or move it to the origin";
    }

private:
    void judge(const volume_case<Element>& input)
    {
        state = input.look(input.as_written(x));
        if (!state.simplices || !input.file().places.single || input.file().places.rounds()) return;
        if (auto in_text = input.look(x); !in_text.simplices) state = std::move(in_text);
    }

    template <class Movable>
    void mend(const volume_case<Element>& input, const Movable& movable)
    {
        const auto before = x;
        auto rounded = input.as_written(x);
        impl::mend_rounding<D>(std::span(input.simplices().cells()), std::span<vec<D>>(rounded), movable);
        for (std::size_t v = 0; v < x.size(); ++v) // a text keeps the digits of what is held
            for (int k = 0; k < D; ++k)
                if (movable(v, k)) x[v][k] = rounded[v][k];
        judge(input);
        std::size_t moved = 0;
        for (std::size_t v = 0; v < x.size(); ++v) moved += x[v] != before[v];
        if (state.simplices)
            note = count(moved, "vertex was", "vertices were") +
                   " moved by units of the last digit, as cells would be flat in the single precision of the file";
    }
};

/// Places of pins as a file holds them, and what that rounds.
class held_by_file
{
public:
    explicit held_by_file(const io::volume_file& file) : rounds_(file.places.rounds()) {}

    /// A coordinate of a pin. Throws unsuitable_input where it is beyond single precision.
    double operator()(idx vertex, double x)
    {
        const double held = rounds_ ? impl::in_single(x) : x;
        if (held == x) return x;
        if (std::isinf(held))
            throw unsuitable_input("the pin of vertex " + std::to_string(vertex) + ": " + number(x) +
                                   " is beyond the single precision of the file; save the input in double precision");
        if (vertices_.empty() || vertices_.back() != vertex) vertices_.push_back(vertex);
        largest_ = std::max(largest_, std::abs(held - x));
        return held;
    }

    template <int D>
    vec<D> operator()(idx vertex, vec<D> x)
    {
        for (int k = 0; k < D; ++k) x[k] = (*this)(vertex, x[k]);
        return x;
    }

    template <int D>
    std::vector<io::pin<D>> operator()(std::vector<io::pin<D>> pins)
    {
        for (auto& p : pins)
            for (int k = 0; k < D && p.hard(); ++k)
                if ((p.held >> k & 1u) != 0) p.target[k] = (*this)(p.vertex, p.target[k]);
        return pins;
    }

    double largest() const { return largest_; }

    /// Empty: nothing was rounded.
    std::string note() const
    {
        if (vertices_.empty()) return {};
        return impl::list_ids("pin", "pins", vertices_) + (vertices_.size() == 1 ? " is" : " are") +
               " rounded to the single precision of the file, by at most " + number(largest_) + ", and fixed there";
    }

private:
    bool rounds_;
    std::vector<idx> vertices_;
    double largest_ = 0;
};

} // namespace taut::tools
