// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/constrain/point_constraints.hpp>
#include <taut/impl/constrain/untangle_problem.hpp>
#include <taut/impl/exact/certify.hpp>
#include <taut/impl/map/session/held_places.hpp>
#include <taut/impl/map/session/session_body.hpp>
#include <taut/impl/untangle/device/live_map.hpp>

namespace taut::impl
{

/// Map of a session on the device, in normalised units, with its fixed coordinates.
template <class Element>
class held_map : public session_body<Element>
{
public:
    static constexpr int D = Element::dimension;
    using typename session_body<Element>::map;

protected:
    using session_body<Element>::last, session_body<Element>::wanted;

    explicit held_map(queue q) : queue_(std::move(q)) {}

    /// The mesh at rest, in normalised units, and its ideal elements' measures.
    virtual const mesh<Element>& rest() const = 0;
    virtual std::span<const double> rest_measure() const = 0;

    /// Target shapes for untangling, and the owners of elements, as in an untangle_problem.
    virtual std::vector<mat<D>> wanted_elements() const { return {}; }
    virtual std::vector<idx> owners() const { return {}; }

    /// Tells the map on the device which coordinates are fixed, if that has changed, and where.
    void constrain()
    {
        auto springs = point_constraints<D>{{}, directed(wanted.springs())}.scaled(lengths_).springs;
        const bool other_marks = held_.take(wanted);
        if (other_marks || !springs.empty() || !springs_.empty())
        {
            springs_ = std::move(springs);
            live_->constrain(held_.marks(), springs_, held_.slides());
        }
        live_->aim(scaled(held_.places()));
        on_way_ = held_.gap(last.x).vertex >= 0;
    }

    /// Replaces the map on the device.
    void load(const map& run_lengths)
    {
        live_->load(run_lengths);
        live_->constrain(held_.marks(), springs_, held_.slides());
        live_->aim(scaled(held_.places()));
    }

    /// Map with fixed coordinates at their targets, regardless of flips. draft: injective map without these.
    untangle_problem<Element> problem(const map& x, bool draft) const
    {
        map there = x;
        held_.impose(there);
        auto held = marks();
        std::vector<idx> sliding;
        for (const auto& s : held_.slides())
        {
            held[static_cast<std::size_t>(s.vertex)] = held.every; // while it untangles
            sliding.push_back(s.vertex);
        }
        return {rest(),   scaled(std::move(there)), std::move(held), draft ? scaled(x) : map(), wanted_elements(),
                owners(), std::move(sliding)};
    }

    /// Certifies a map in the user's lengths, with det of the elements in these lengths, too.
    virtual certificate certified(const map& x) const
    {
        auto flips = certify<D>(rest().cells(), std::span<const vec<D>>(x), rest_measure(), 16, owners());
        for (double* det : {&flips.min_det, &flips.max_det}) *det *= std::pow(lengths_, D);
        return flips;
    }

    /// Progress for the observer.
    progress seen() const
    {
        if constexpr (D == 2)
            return {.coordinates = [this] { return user_coordinates(); }};
        else
            return {.positions = [this] { return user_coordinates(); }};
    }

    /// One per vertex, also where nothing is fixed.
    fixed_marks<D> marks() const { return held_.marks().empty() ? fixed_marks<D>(last.x.size()) : held_.marks(); }

    map user_coordinates() const { return unscaled(live_->coordinates()); }

    /// The same, with coordinates that equal their targets there set to the last bit.
    map placed() const
    {
        auto x = user_coordinates();
        held_.impose(x, unscaled(live_->as_held(scaled(held_.places()))));
        return x;
    }

    /// In the lengths of the map.
    map unscaled(map x) const
    {
        for (vec<D>& p : x) p /= lengths_;
        return x;
    }

    /// In normalised units.
    map scaled(map x) const
    {
        for (vec<D>& p : x) p *= lengths_;
        return x;
    }

    queue queue_;
    double lengths_ = 1; ///< of the run by those of the map
    std::optional<live_map<Element>> live_;
    held_places<Element> held_;
    bool on_way_ = false; ///< fixed coordinates of the map on the device are not at their places

private:
    std::vector<directed_spring<D>> springs_; ///< in normalised units
};

} // namespace taut::impl
