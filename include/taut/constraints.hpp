// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_CONSTRAINTS_HPP
#define TAUT_CONSTRAINTS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/elements.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/constrain/arc_length.hpp>
#include <taut/impl/core/constrain/long_rotation.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/mesh/arrays.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/mesh.hpp>
#include <taut/types.hpp>

/// Pins, springs, boundaries and slides.
namespace taut
{

/// Hard pin: coordinates of a vertex that are fixed exactly: bit k of `held` says that coordinate k is value[k].
template <int D>
struct hard_pin
{
    std::uint8_t held = 0;
    vec<D> value{0.0};
};

/// Spring (soft constraint): weight * |x - target|^2 is added to the objective.
template <int D>
struct spring
{
    idx vertex;
    vec<D> target;
    double weight;
};

/// Placement of a map with a free boundary and no constraints, which is unique up to rigid motions only.
enum class placement
{
    upright,     ///< in the units of the surface, y up or x to the right, the lower left corner of its box at (0, 0)
    unit_square, ///< the same, scaled to the square [0, 1]^2, of which its box takes a whole side
    as_solved    ///< as left by the solver: near `initial`, or anywhere
};

/// Sliding constraint: a vertex that moves along a line, or in a plane, through its position.
template <int D>
struct slide
{
    idx vertex;
    glm::mat<D, D, double> projection; ///< projection of displacements on the allowed directions: symmetric, P P = P

    /// Makes a slide perpendicular to a direction of any length but 0: in a plane, or in 2D along a line.
    static slide across(idx v, const vec<D>& normal)
    {
        return {v, glm::mat<D, D, double>(1.0) - glm::outerProduct(normal, normal) / glm::dot(normal, normal)};
    }

    /// Makes a slide along a direction of any length but 0.
    static slide along(idx v, const vec<D>& direction)
    {
        return {v, glm::outerProduct(direction, direction) / glm::dot(direction, direction)};
    }
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

    /// The same to transform(p) of one position p each, as move() has it.
    template <class Transform>
    constraints& repin(std::span<const idx> vertices, std::span<const point> from, const Transform& transform)
    {
        require_count("a vertex", vertices.size(), from.size());
        return hold_images(
            vertices, [&](std::size_t i) { return from[i]; }, transform, true);
    }

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

    /// Pins vertices at their rest positions: volumes and planar surfaces, all z equal. Throws also for no_position.
    constraints& fix(std::span<const idx> vertices)
    {
        return move(vertices, [](const point& p) { return p; });
    }
    constraints& fix(std::initializer_list<idx> vertices) { return fix(std::span(vertices.begin(), vertices.size())); }

    /// Pins vertices to transform(p), p their positions in the map x. A rigid_motion is followed for its whole angle,
    /// any number of turns.
    template <class Transform>
    constraints& move(std::span<const idx> vertices, std::span<const point> x, const Transform& transform)
    {
        require_count("a vertex", count(), x.size());
        const auto from = [&](std::size_t i) { return x[static_cast<std::size_t>(vertices[i])]; };
        return hold_images(vertices, from, transform);
    }

    /// Pins vertices to transform(p), p their rest positions. Throws also for no_position.
    template <class Transform>
    constraints& move(std::span<const idx> vertices, const Transform& transform)
    {
        require_positions_at_rest();
        return hold_images(
            vertices, [&](std::size_t i) { return point(rest(vertices[i])); }, transform);
    }

    /// Says that pinned vertices get from these positions, one each, to their places by this motion: that counts where
    /// it is a rotation of half a turn and more, which their places do not tell.
    constraints& rotate(std::span<const idx> vertices, std::span<const point> from, const rigid_motion<D>& motion)
    {
        require_count("a vertex", vertices.size(), from.size());
        require_vertices(vertices);
        if (!vertices.empty() && impl::long_rotation<D>::is_long(motion))
            rotations_.emplace_back(vertices, std::vector<point>(from.begin(), from.end()), motion);
        return *this;
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

    /// Rotations that are not done yet.
    const std::vector<impl::long_rotation<D>>& rotations() const { return rotations_; }
    void rotations(std::vector<impl::long_rotation<D>> left) { rotations_ = std::move(left); }

    /// Pins, ascending by vertex.
    const std::map<idx, hard_pin<D>>& pins() const { return pins_; }

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
            if (mesh_ && !impl::is_planar(mesh_->points()))
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

    /// Pins vertices to transform(from(i)), i counting through them.
    template <class From, class Transform>
    constraints& hold_images(std::span<const idx> vertices, const From& from, const Transform& transform,
                             bool replace = false)
    {
        if constexpr (std::same_as<Transform, rigid_motion<D>>)
            if (!(std::abs(glm::length(transform.axis) - 1) < 1e-6))
                throw parameter_error("axis", "must have length 1; normalise it, or use rigid_motion::about()");
        hold(
            vertices, all, [&](std::size_t i) { return transform(from(i)); }, replace);
        if constexpr (std::same_as<Transform, rigid_motion<D>>)
        {
            std::vector<point> places;
            for (std::size_t i = 0; i < vertices.size(); ++i) places.push_back(from(i));
            rotate(vertices, places, transform);
        }
        return *this;
    }

    /// Forgets by which rotation a vertex gets to its place.
    void forget_rotation(idx v)
    {
        for (auto& r : rotations_) r.remove(v);
        std::erase_if(rotations_, [](const auto& r) { return r.vertices().empty(); });
    }

    const mesh<Element>* mesh_ = nullptr;
    std::map<idx, hard_pin<D>> pins_;
    std::map<idx, taut::spring<D>> springs_;
    std::vector<impl::long_rotation<D>> rotations_;
};

// Compiled once, with the bodies.
extern template class constraints<triangle>;

extern template class constraints<tetrahedron>;

} // namespace taut

#endif
#include <taut/impl/leave.inl>
