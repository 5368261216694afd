// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_DEFORM
#endif
#ifndef TAUT_SESSION_HPP
#define TAUT_SESSION_HPP

#include <chrono>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/core/solve/stop.hpp>
#include <taut/options.hpp>
#include <taut/parameterize.hpp>
#include <taut/queue.hpp>
#include <taut/shell.hpp>
#include <taut/solve_params.hpp>

/// Interactive sessions: drag pins, and the map follows.
namespace taut
{

template <class Element>
struct deform_params;

} // namespace taut

namespace taut::impl
{

template <class Element>
class session_body;

} // namespace taut::impl

namespace taut
{

/// Parameters of deform() and of sessions of thin shells. Every field has a sensible default.
struct shell_params
{
    /// Pins, which are met bit for bit, and springs, of the mesh thin_shell::hinges().
    taut::constraints<hinge> constraints = {};

    /// Thickness in the lengths of the surface; none: the mean edge. The cost of bending against stretching is that of
    /// a plate of this thickness: thin shells crease and wrinkle where thick ones arch. Range > 0.
    std::optional<double> thickness = {};

    /// Initial shape, if it is not that at rest: of the last step, say. One position per vertex.
    std::vector<vec3> initial = {};

    taut::precision precision = precision::automatic;

    /// As in deform_params.
    solve::params solve = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (thickness && (!(*thickness > 0) || !std::isfinite(*thickness)))
            throw parameter_error("thickness", "must be positive and finite");
    }
};

/// Limits of one call of session::solve. The first that is reached ends it. At least one step is made if there is
/// something to do, except by the first call, which may return its initial shape.
struct session_budget
{
    /// Wall-clock limit. No step is begun that would exceed it if it took as long as the last one.
    std::chrono::duration<double> time = std::chrono::duration<double>(std::numeric_limits<double>::infinity());

    /// Maximum number of Newton steps. Range >= 1.
    int steps = std::numeric_limits<int>::max();

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!(time.count() >= 0)) throw parameter_error("time", "must not be negative");
        if (steps < 1) throw parameter_error("steps", "must be at least 1");
    }
};

/// Wall-clock seconds of the phases of one call.
struct session_seconds
{
    double start = 0;       ///< the first map or shape, and what is made once for all calls
    double constrain = 0;   ///< updates of the fixed coordinates and their targets
    double follow = 0;      ///< steps that bring pins to their targets
    double repair = 0;      ///< untangling, where such steps stuck
    double solve = 0;       ///< minimisation with the pins at their targets
    double certificate = 0; ///< the map back from the device, and the count of its defects
    double total() const { return start + constrain + follow + repair + solve + certificate; }
};

/// Report of one call of session::solve: its steps, and the measures and certificate of the map.
struct session_report
{
    /// `valid`: there is a certified map, though pins may be away from their places: see pins_held. Otherwise reason
    /// and ids are as in map_report, and there are no coordinates but those of deform(), with the defects that ids
    /// name.
    taut::outcome outcome = outcome::no_valid_start;
    std::string reason;             ///< why there is no valid map, or why the pins cannot be reached; else empty
    std::vector<idx> ids;           ///< elements or vertices that the reason concerns
    std::vector<std::string> notes; ///< decisions of the library
    bool converged = false;         ///< pins are met, and the map is a minimum
    bool stopped = false;           ///< the budget, a limit or the observer ended the call
    bool pins_held = false;         ///< all pins are met, bit for bit
    idx farthest = -1;              ///< the vertex farthest from its pin; -1: pins are met
    double distance = 0;            ///< distance of that vertex from its pin
    double energy = 0;              ///< mean over the elements, springs included
    double gradient = 0;            ///< relative norm of the gradient, where pins are met
    int steps = 0;                  ///< Newton steps of this call
    certificate flips;              ///< certificate of the returned map, exact
    session_seconds seconds;
    std::vector<stage_report> stages; ///< stages of this call, in their order in time
    queue_counters counters;          ///< counts of this call
};

std::ostream& operator<<(std::ostream& out, const session_report& r);

/// Result of session::solve: positions and a report; `auto [uv, report] = s.solve(...)`.
template <class Element>
struct session_result
{
    std::vector<vec<Element::dimension>> x; ///< one per vertex, in the user's order and lengths
    session_report report;

    /// True if there is a map: it is certified. Pins may still be away from their places: report.pins_held.
    explicit operator bool() const { return report.outcome == outcome::valid; }
    const std::string& reason() const { return report.reason; }
};

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

    /// Opens a session of a deforming planar mesh, all z equal.
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

    /// Pins vertices to the images of their last positions under a function. A rigid_motion is followed for its whole
    /// angle, any number of turns, which places alone do not tell. Throws also no_position: there is no map yet.
    template <std::invocable<point> Transform>
    session& move(std::span<const idx> vertices, const Transform& transform)
    {
        const std::vector<point> places = body_->places_of(vertices);
        return change([&](auto& c) { c.repin(vertices, places, transform); });
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
    session_result<Element> solve(const session_budget& budget = {})
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

session(queue&, const mesh<tetrahedron>&)->session<tetrahedron>;
session(queue&, const mesh<tetrahedron>&, const deform_params<tetrahedron>&, const run_limits& = {})
    ->session<tetrahedron>;

session(queue&, const thin_shell&, const shell_params& = {}, const run_limits& = {})->session<hinge>;

} // namespace taut

#include <taut/deform.hpp>                             // parameters of shapes
#include <taut/impl/core/map/session/session_body.hpp> // what its members call

#endif
#include <taut/impl/leave.inl>
