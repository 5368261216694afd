// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/constrain/constraint_error.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>

namespace taut
{

template <class Element>
constraints<Element>& constraints<Element>::pin(idx v, int k, double value)
{
    require_coordinate(v, k);
    point x(0.0);
    x[k] = value;
    return hold(std::array{v}, static_cast<std::uint8_t>(1u << k), [&](std::size_t) { return x; });
}

template <class Element>
constraints<Element>& constraints<Element>::repin(idx v, int k, double value)
{
    require_coordinate(v, k);
    point x(0.0);
    x[k] = value;
    return hold(
        std::array{v}, static_cast<std::uint8_t>(1u << k), [&](std::size_t) { return x; }, true);
}

template <class Element>
constraints<Element>& constraints<Element>::respring(idx v, const point& x, double weight)
{
    const auto old = springs_.extract(v);
    try
    {
        return spring(v, x, weight);
    }
    catch (...)
    {
        if (old) springs_.insert({v, old.mapped()});
        throw;
    }
}

template <class Element>
constraints<Element>& constraints<Element>::release(idx v)
{
    require_vertices(std::array{v});
    pins_.erase(v);
    springs_.erase(v);
    forget_rotation(v);
    return *this;
}

template <class Element>
constraints<Element>& constraints<Element>::spring(idx v, const point& x, double weight)
{
    require_vertices(std::array{v});
    if (!finite(x, all)) impl::refuse_vertices(constraint_error::not_finite, {v}, not_finite_);
    if (!(weight >= 0) || !std::isfinite(weight))
        impl::refuse_vertices(constraint_error::bad_weight, {v},
                              "with a spring whose weight is negative or not finite; give a finite one >= 0");
    if (held(v) == all) impl::refuse_vertices(constraint_error::idle_spring, {v}, idle_spring_);
    if (!springs_.try_emplace(v, taut::spring<D>{v, x, weight}).second)
        impl::refuse_vertices(constraint_error::duplicate, {v}, "with a second spring; leave one out");
    return *this;
}

template <class Element>
void constraints<Element>::require_near(double unit) const
{
    std::vector<idx> far;
    for (const auto& [v, pin] : pins_)
        if (!finite(pin.value * unit, pin.held)) far.push_back(v);
    for (const auto& [v, s] : springs_)
        if (!finite(s.target * unit, all)) far.push_back(v);
    impl::refuse_vertices(constraint_error::not_finite, std::move(far),
                          "with a target that is too far away for the size of the mesh; give a nearer one");
}

template <class Element>
void constraints<Element>::require_used(std::span<const idx> unused) const
{
    if (unused.empty()) return;
    std::vector<idx> bad;
    const auto is_unused = [&](idx v) { return std::binary_search(unused.begin(), unused.end(), v); };
    for (const auto& [v, pin] : pins_)
        if (is_unused(v)) bad.push_back(v);
    for (const auto& [v, s] : springs_)
        if (is_unused(v) && !pins_.contains(v)) bad.push_back(v);
    std::sort(bad.begin(), bad.end());
    impl::refuse_vertices(constraint_error::unused_vertex, std::move(bad),
                          std::string("pinned that no ") + Element::name +
                              " uses, so that nothing follows; pin others, or leave the pins out");
}

template <class Element>
constraints<Element> constraints<Element>::on(const mesh<Element>& copy) const
{
    constraints c = *this;
    c.mesh_ = &copy;
    for (const auto& [v, pin] : pins_) c.require_vertices(std::array{v});
    for (const auto& [v, s] : springs_) c.require_vertices(std::array{v});
    return c;
}

template <class Element>
std::vector<taut::spring<constraints<Element>::D>> constraints<Element>::springs() const
{
    std::vector<taut::spring<D>> list;
    for (const auto& [v, s] : springs_) list.push_back(s);
    return list;
}

template <class Element>
impl::fixed_marks<constraints<Element>::D> constraints<Element>::held() const
{
    impl::fixed_marks<D> marks(count());
    for (const auto& [v, p] : pins_) marks[static_cast<std::size_t>(v)] = p.held;
    return marks;
}

template <class Element>
void constraints<Element>::impose(std::span<point> x) const
{
    require_count("a vertex", count(), x.size());
    for (const auto& [v, p] : pins_)
        for (int k = 0; k < D; ++k)
            if ((p.held >> k & 1u) != 0) x[static_cast<std::size_t>(v)][k] = p.value[k];
}

template <class Element>
void constraints<Element>::require_vertices(std::span<const idx> vertices) const
{
    std::vector<idx> bad;
    for (const idx v : vertices)
        if (v < 0 || static_cast<std::size_t>(v) >= count()) bad.push_back(v);
    impl::refuse_vertices(constraint_error::out_of_range, std::move(bad),
                          "that the mesh does not have; it has " + std::to_string(count()) + ", numbered from 0");
}

template <class Element>
void constraints<Element>::require_coordinate(idx v, int k)
{
    if (k < 0 || k >= D)
        throw constraint_error(constraint_error::no_coordinate, {v},
                               "vertex " + std::to_string(v) + " has no coordinate " + std::to_string(k) +
                                   "; they count from 0 to " + std::to_string(D - 1));
}

template <class Element>
void constraints<Element>::require_count(const char* what, std::size_t wanted, std::size_t given)
{
    if (wanted != given)
        throw constraint_error(constraint_error::wrong_count, {},
                               std::to_string(given) + " positions; give one " + what + ": " + std::to_string(wanted));
}

template <class Element>
constraints<Element>& constraints<Element>::hold(std::span<const idx> vertices, std::uint8_t coordinates,
                                                 const std::function<point(std::size_t)>& where, bool replace)
{
    require_vertices(vertices);
    std::vector<idx> not_finite, contradictory, duplicate, idle;
    std::map<idx, hard_pin<D>> added;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        const idx v = vertices[i];
        const point x = where(i);
        if (!finite(x, coordinates)) not_finite.push_back(v);
        const auto earlier = pins_.find(v);
        const auto [at, is_new] = added.try_emplace(v, earlier == pins_.end() ? hard_pin<D>{} : earlier->second);
        hard_pin<D>& p = at->second;
        bool again = false, differs = false;
        for (int k = 0; k < D; ++k)
        {
            if ((coordinates >> k & 1u) == 0) continue;
            const bool taken = !(replace && is_new) && (p.held >> k & 1u) != 0;
            again = again || taken;
            differs = differs || (taken && p.value[k] != x[k]);
            if (!taken) p.value[k] = x[k];
        }
        p.held = static_cast<std::uint8_t>(p.held | coordinates);
        if (again) (differs ? contradictory : duplicate).push_back(v);
        if (p.held == all && springs_.contains(v)) idle.push_back(v);
    }
    impl::refuse_vertices(constraint_error::not_finite, std::move(not_finite), not_finite_);
    impl::refuse_vertices(constraint_error::contradictory, std::move(contradictory),
                          "pinned to two different positions; leave one of the pins out");
    impl::refuse_vertices(constraint_error::duplicate, std::move(duplicate),
                          "pinned twice to the same position; leave one of the pins out");
    impl::refuse_vertices(constraint_error::idle_spring, std::move(idle), idle_spring_);
    for (auto& [v, p] : added) pins_.insert_or_assign(v, p), forget_rotation(v);
    return *this;
}

} // namespace taut

namespace taut
{

template class constraints<triangle>;
template class constraints<tetrahedron>;

} // namespace taut
