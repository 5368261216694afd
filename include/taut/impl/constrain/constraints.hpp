// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/constrain/arc_length.hpp>
#include <taut/impl/constrain/constraint_error.hpp>
#include <taut/impl/core/fixed_marks.hpp>
#include <taut/impl/mesh/boundary.hpp>
#include <taut/impl/mesh/tetrahedron.hpp>

namespace taut::impl
{

/// Hard pin: coordinates of a vertex that are fixed exactly: bit k of `held` says that coordinate k is value[k].
template <int D>
struct hard_pin
{
    std::uint8_t held = 0;
    vec<D> value{0.0};
};

} // namespace taut::impl

namespace taut
{

/// Spring (soft constraint): weight * |x - target|^2 is added to the objective.
template <int D>
struct spring
{
    idx vertex;
    vec<D> target;
    double weight;
};

/// Positional constraints of a map: pins, which are met bit for bit, and springs, which are penalties.
///
///     auto pins = taut::constraints(mesh).pin(12, {0, 0}).pin_u(5, 0.3).spring(40, {0.5, 0.5}, 10.0);
///
/// Positions are in units of the map; vertices count from 0. The mesh has to live as long as constraints are added, not
/// longer. A call that throws changes nothing. All of them throw constraint_error: out_of_range, not_finite;
/// contradictory and duplicate where a coordinate is fixed already.
template <class Element = triangle>
class constraints
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::uint8_t all = impl::fixed_marks<D>::every; ///< all bits of held: every coordinate
    using point = vec<D>;

    constraints() = default; ///< none, of no mesh
    explicit constraints(const mesh<Element>& m) : mesh_(&m) {}
    explicit constraints(mesh<Element>&&) = delete; // a temporary would be gone when the next pin asks for it

    /// Pins vertex v to x.
    constraints& pin(idx v, const point& x)
    {
        return hold(std::array{v}, all, [&](std::size_t) { return x; });
    }

    /// Pins coordinate k of vertex v alone. Throws constraint_error also for no_coordinate.
    constraints& pin(idx v, int k, double value);

    /// Adds the pins and springs of a file (io::read_pins()). Throws constraint_error.
    template <class Pin>
    constraints& add(const std::vector<Pin>& pins)
    {
        for (const Pin& p : pins)
        {
            if (!p.hard())
                spring(p.vertex, p.target, p.weight);
            else if (p.held == all)
                pin(p.vertex, p.target);
            else
                for (int k = 0; k < D; ++k)
                    if ((p.held >> k & 1u) != 0) pin(p.vertex, k, p.target[k]);
        }
        return *this;
    }

    constraints& pin_u(idx v, double u) { return pin(v, 0, u); }
    constraints& pin_v(idx v, double value) { return pin(v, 1, value); }

    /// Pins vertices to one position each, and replaces earlier pins of them.
    constraints& repin(std::span<const idx> vertices, std::span<const point> x)
    {
        require_count("a vertex", vertices.size(), x.size());
        return hold(
            vertices, all, [&](std::size_t i) { return x[i]; }, true);
    }
    constraints& repin(idx v, const point& x) { return repin(std::array{v}, std::array{x}); }

    /// The same for coordinate k of vertex v alone; the others stay as they are.
    constraints& repin(idx v, int k, double value);

    /// Adds or replaces the spring of v, as spring().
    constraints& respring(idx v, const point& x, double weight);

    /// Removes pins and springs of vertex v, if there are any.
    constraints& release(idx v);

    /// Pins the whole boundary, one loop, to a closed polygon: the loop goes around it once, in proportion to the rest
    /// lengths of the edges. `first` is pinned to the polygon's first corner; -1: the boundary vertex of the smallest
    /// number. The surface is to the left of the loop, so a counter-clockwise polygon preserves its orientation. Throws
    /// constraint_error (bad_polygon, out_of_range if `first` is not on the boundary); mesh_error unless there is one
    /// boundary loop.
    // A template, as clang 14 compiles all members with the class, whatever they require.
    template <class Planar = Element>
        requires(Planar::dimension == 2)
    constraints& pin_boundary(std::span<const vec2> polygon, idx first = -1)
    {
        auto loop = boundary_loop();
        if (first >= 0)
        {
            const auto start = std::find(loop.begin(), loop.end(), first);
            if (start == loop.end())
                throw constraint_error(constraint_error::out_of_range, {first},
                                       "vertex " + std::to_string(first) +
                                           " is not on the boundary; start at one of its vertices");
            std::rotate(loop.begin(), start, loop.end());
        }
        std::vector<double> lengths;
        for (std::size_t k = 0; k < loop.size(); ++k)
            lengths.push_back(glm::distance(rest(loop[k]), rest(loop[(k + 1) % loop.size()])));
        const auto x = impl::along_polygon(polygon, lengths);
        return hold(loop, all, [&](std::size_t i) { return x[i]; });
    }

    /// Pins the whole boundary, one loop, to one position per vertex, in the order of boundary_loops().
    /// Throws constraint_error (wrong_count); mesh_error unless there is one boundary loop.
    template <class Planar = Element>
        requires(Planar::dimension == 2)
    constraints& pin_boundary_at(std::span<const vec2> positions)
    {
        const auto loop = boundary_loop();
        require_count("a boundary vertex", loop.size(), positions.size());
        return hold(loop, all, [&](std::size_t i) { return positions[i]; });
    }

    /// Pins vertices at their positions in the map x (one per vertex of the mesh).
    constraints& fix(std::span<const idx> vertices, std::span<const point> x)
    {
        return move(vertices, x, [](const point& p) { return p; });
    }

    /// Pins vertices at their rest positions: volumes and planar surfaces (z = 0). Throws also for no_position.
    constraints& fix(std::span<const idx> vertices)
    {
        return move(vertices, [](const point& p) { return p; });
    }

    /// Pins vertices to transform(p), p their positions in the map x.
    template <class Transform>
    constraints& move(std::span<const idx> vertices, std::span<const point> x, const Transform& transform)
    {
        require_count("a vertex", count(), x.size());
        return hold(vertices, all, [&](std::size_t i) { return transform(x[static_cast<std::size_t>(vertices[i])]); });
    }

    /// Pins vertices to transform(p), p their rest positions. Throws also for no_position.
    template <class Transform>
    constraints& move(std::span<const idx> vertices, const Transform& transform)
    {
        require_positions_at_rest();
        return hold(vertices, all, [&](std::size_t i) { return transform(point(rest(vertices[i]))); });
    }

    /// Adds a spring from vertex v to x; a weight of 0 does nothing. Throws constraint_error also for bad_weight,
    /// idle_spring.
    constraints& spring(idx v, const point& x, double weight);

    bool empty() const { return pins_.empty() && springs_.empty(); }

    /// Checks that targets are finite in lengths of `unit` times these. Throws constraint_error (not_finite).
    void require_near(double unit) const;

    /// Checks that these unreferenced vertices, ascending, have no constraints. Throws constraint_error
    /// (unused_vertex).
    void require_used(std::span<const idx> unused) const;

    /// Copies the constraints to a copy of the mesh. Throws constraint_error for another mesh, with fewer vertices.
    constraints on(const mesh<Element>& copy) const;

    /// Pins, ascending by vertex.
    const std::map<idx, impl::hard_pin<D>>& pins() const { return pins_; }

    /// Springs, ascending by vertex.
    std::vector<taut::spring<D>> springs() const;

    /// Fixed coordinates of vertex v: bit k for coordinate k.
    std::uint8_t held(idx v) const
    {
        const auto at = pins_.find(v);
        return at == pins_.end() ? std::uint8_t{0} : at->second.held;
    }

    /// Fixed coordinates of all vertices, as held(), one per vertex.
    impl::fixed_marks<D> held() const;

    /// Sets the fixed coordinates of a map (one position per vertex) to their targets.
    void impose(std::span<point> x) const;

private:
    static constexpr const char* not_finite_ =
        "with a target that is not finite, or so far away that distances are not; give nearer coordinates";
    static constexpr double farthest_ = std::numeric_limits<double>::max() / 2; // so that differences are finite
    static constexpr const char* idle_spring_ = "with a spring and a pin, which leaves the spring nothing to do; "
                                                "leave one of them out";

    std::size_t count() const { return mesh_ ? mesh_->points().size() : 0; }
    const vec3& rest(idx v) const { return mesh_->points()[static_cast<std::size_t>(v)]; }

    static bool finite(const point& x, std::uint8_t coordinates)
    {
        for (int k = 0; k < D; ++k)
            if ((coordinates >> k & 1u) != 0 && !(std::abs(x[k]) <= farthest_)) return false;
        return true;
    }

    void require_vertices(std::span<const idx> vertices) const;

    static void require_coordinate(idx v, int k);

    static void require_count(const char* what, std::size_t wanted, std::size_t given);

    void require_positions_at_rest() const
    {
        if constexpr (D == 2)
            if (mesh_ &&
                std::any_of(mesh_->points().begin(), mesh_->points().end(), [](const vec3& p) { return p.z != 0; }))
                throw constraint_error(constraint_error::no_position, {},
                                       "a surface in space has no place in the plane yet; give the map, too");
    }

    template <class Planar = Element>
    std::vector<idx> boundary_loop() const
    {
        if (!mesh_) return {};
        auto loops = boundary_loops(*mesh_);
        if (loops.empty()) throw mesh_error(impl::describe<Element>(mesh_error::closed_surface, {}));
        if (loops.size() > 1)
        {
            std::vector<idx> first;
            for (const auto& loop : loops) first.push_back(loop[0]);
            throw mesh_error(impl::describe<Element>(mesh_error::several_boundaries, std::move(first)));
        }
        return std::move(loops.front());
    }

    /// Fixes `coordinates` of the vertices at where(i), i counting through them: all or, where it throws, none.
    /// replace: true if earlier pins are replaced.
    constraints& hold(std::span<const idx> vertices, std::uint8_t coordinates,
                      const std::function<point(std::size_t)>& where, bool replace = false);

    const mesh<Element>* mesh_ = nullptr;
    std::map<idx, impl::hard_pin<D>> pins_;
    std::map<idx, taut::spring<D>> springs_;
};

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
                          "that the mesh does not have; it has " + std::to_string(count()) + ", counted from 0");
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
    std::map<idx, impl::hard_pin<D>> added;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        const idx v = vertices[i];
        const point x = where(i);
        if (!finite(x, coordinates)) not_finite.push_back(v);
        const auto earlier = pins_.find(v);
        const auto [at, is_new] = added.try_emplace(v, earlier == pins_.end() ? impl::hard_pin<D>{} : earlier->second);
        impl::hard_pin<D>& p = at->second;
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
    for (auto& [v, p] : added) pins_.insert_or_assign(v, p);
    return *this;
}

// Compiled once, with the bodies.
extern template class constraints<triangle>;
extern template class constraints<tetrahedron>;

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/constrain/constraints.ipp>
#endif
