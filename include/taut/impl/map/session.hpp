// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <memory>
#include <span>
#include <vector>

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/map/deform_params.hpp>
#include <taut/impl/map/parameterize_params.hpp>
#include <taut/impl/map/session/session_body.hpp>
#include <taut/impl/map/session_result.hpp>
#include <taut/impl/map/shell_params.hpp>

namespace taut
{

/// Interactive session of a map or of a deforming shape. It keeps the mesh, its order and hierarchy, the tables and
/// kernels of all levels, and the last map, so that a call of solve() costs steps of Newton's method and nothing else.
/// Pins may be added, moved and removed between calls: no table depends on them.
///
///     taut::session s(queue, surface);
///     auto [uv, report] = s.solve();                // as parameterize()
///     s.pin(v, uv[v]);
///     while (dragging) show(s.pin(v, mouse()).solve({.time = 12ms}).x);
///
/// Each map that is returned is injective and certified as those of parameterize(). Pins are brought to their targets
/// through injective maps, so a map changes as much as its pins move: it does not jump to another minimum, nor wind
/// twice around a vertex. Unfinished work is reported, and the next call continues it.
///
/// Not to be used from two threads at once. Objects may be moved, not copied.
template <class Element>
class session
{
public:
    static constexpr int D = Element::dimension;
    using point = vec<D>;

    /// Opens a session of a map of a surface. Validates; the first solve() computes the first map. params: as for
    /// parameterize(); `constraints` are the initial ones. limits: time of the first map, observer of all calls. Throws
    /// mesh_error, parameter_error (also for a method other than Newton's), constraint_error for constraints of another
    /// mesh.
    session(queue& q, const mesh<Element>& m, const parameterize_params& params = {},
            const run_limits& limits = {}) requires std::same_as<Element, triangle>;

    /// Opens a session of a deforming volume; the first shape is that of the mesh, or params.initial, untangled if it
    /// has inverted elements. Throws as above.
    session(queue& q, const mesh<Element>& m, const deform_params<Element>& params = {},
            const run_limits& limits = {}) requires std::same_as<Element, tetrahedron>;

    /// Opens a session of a deforming mesh of the plane (z = 0).
    template <std::same_as<deform_params<Element>> Params>
    session(queue& q, const mesh<Element>& m, const Params& params,
            const run_limits& limits = {}) requires std::same_as<Element, triangle>;

    /// Opens a session of a thin shell, taut::session<hinge>: maps are its shapes, which are certified to have no
    /// triangle collapsed to a line or a point; the surface may intersect itself.
    session(queue& q, const thin_shell& shell, const shell_params& params = {},
            const run_limits& limits = {}) requires std::same_as<Element, hinge>;

    /// Pins vertex v to x, in the lengths of the map, or moves its pin there. Throws constraint_error, as
    /// constraints::pin does, and all of the session is as before.
    session& pin(idx v, const point& x)
    {
        return change([&](auto& c) { c.repin(v, x); });
    }
    /// The same for coordinate k alone.
    session& pin(idx v, int k, double value)
    {
        return change([&](auto& c) { c.repin(v, k, value); });
    }
    session& pin_u(idx v, double u) { return pin(v, 0, u); }
    session& pin_v(idx v, double value) { return pin(v, 1, value); }

    /// Pins vertices to one place each, or moves their pins there; all of them, or, where it throws, none.
    session& move(std::span<const idx> vertices, std::span<const point> places)
    {
        return change([&](auto& c) { c.repin(vertices, places); });
    }

    /// Pins vertices to the images of their last positions under a function. Throws also no_position: there is no map
    /// yet.
    template <std::invocable<point> Transform>
    session& move(std::span<const idx> vertices, const Transform& transform)
    {
        std::vector<point> places = body_->places_of(vertices);
        for (point& p : places) p = transform(p);
        return move(vertices, places);
    }

    /// Adds a spring from vertex v to x, or replaces its spring.
    session& spring(idx v, const point& x, double weight)
    {
        return change([&](auto& c) { c.respring(v, x, weight); });
    }

    /// Removes pin and spring of vertex v, if there are any.
    session& release(idx v)
    {
        return change([&](auto& c) { c.release(v); });
    }

    /// Restores earlier constraints and the map of that time, as for an undo: the next solve() continues from there. x:
    /// one position per vertex. Throws parameter_error, and all is as before, where x has another size or is not
    /// injective, or where there was no map yet; constraint_error for constraints of another mesh.
    session& restore(const taut::constraints<Element>& asked, const std::vector<point>& x)
    {
        body_->restore(asked, x);
        return *this;
    }

    /// Current constraints.
    const taut::constraints<Element>& constraints() const { return body_->wanted; }

    /// Last map; empty before there was one.
    const std::vector<point>& x() const { return body_->last.x; }

    /// Continues from the last map until convergence or the end of the budget; without a map, computes the first one,
    /// as parameterize() does. Throws parameter_error, device_error.
    session_result<Element> solve(const impl::session_budget& budget = {})
    {
        budget.validate();
        return body_->solve(budget);
    }

private:
    template <class F>
    session& change(const F& f)
    {
        f(body_->wanted); // where it throws it changes nothing
        body_->changed = true;
        return *this;
    }

    std::unique_ptr<impl::session_body<Element>> body_;
};

// clang 14 takes no account of the constraints of constructors where it deduces Element.
session(queue&, const mesh<triangle>&, const parameterize_params& = {}, const run_limits& = {})->session<triangle>;
template <std::same_as<deform_params<triangle>> Params>
session(queue&, const mesh<triangle>&, const Params&, const run_limits& = {}) -> session<triangle>;
session(queue&, const mesh<tetrahedron>&, const deform_params<tetrahedron>& = {}, const run_limits& = {})
    ->session<tetrahedron>;
session(queue&, const thin_shell&, const shell_params& = {}, const run_limits& = {})->session<hinge>;

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/map/session/map_session.ipp>
#include <taut/impl/map/session/shape_session.ipp>
#endif
