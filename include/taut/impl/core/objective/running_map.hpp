// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/constrain/fixed_coordinates.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/exact/collapses.hpp>
#include <taut/impl/core/measure/planar_size.hpp>
#include <taut/impl/core/objective/mapped_mesh.hpp>
#include <taut/impl/core/objective/minimizers.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Map of a mesh on a device, with the data to minimise its energy: order, tables of all levels, kernels, matrices. No
/// vertex is pinned in the layout: fixed coordinates are a mask, which can change. Vertices are in the user's order,
/// maps in the user's lengths.
template <class Element>
class running_map
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    /// Refers to the mesh. There is no map yet.
    running_map(queue q, const mapped_mesh<Element>& of) : queue_(std::move(q)), of_(of) {}

    fixed_coordinates<Element> fixed; ///< known to the device after load() or constrain()
    bool automatic = false;           ///< double may be used where float leads no further

    bool loaded() const { return bool(device_); }
    const mapped_mesh<Element>& of() const { return of_; }
    const queue& on() const { return queue_; }

    /// Makes tables and kernels in a precision, and loads a map.
    void load(const map& x, precision how)
    {
        device_.emplace(queue_, of_, types_of(how));
        load(x);
    }

    /// Replaces the map by an injective one.
    void load(const map& x);

    /// Replaces the map by one in normalised units whose fixed coordinates are at their targets.
    void load_placed(map x)
    {
        x = of_.unscaled(std::move(x));
        fixed.impose(x);
        load(x);
    }

    /// Replaces the constraints.
    void constrain(const constraints<Element>& wanted);

    /// Sets where follow() leads, for now: target(v) for the fixed coordinates of vertex v.
    template <class Target>
    void aim(const Target& target);

    /// The same, at the targets themselves.
    void aim()
    {
        aim([this](std::size_t v) { return fixed.targets()[v]; });
    }

    /// Brings fixed coordinates to the targets of aim(), by incremental loading. gap: the largest distance, in
    /// normalised units.
    solve::impl::prescribed_report follow(double gap,
                                          const std::function<bool(const solve::impl::prescribed_report&)>& proceed);

    /// Minimises with fixed coordinates where they are.
    solve::report minimise(const solve::params& how, const run_limits& limits)
    {
        auto r = solve::minimize(device_->objective, device_->x, how, limits);
        for (int& c : r.capping) c = device_->cells[static_cast<std::size_t>(c)];
        return r;
    }

    /// Returns whether energies and directions are in single precision.
    bool in_float() const { return device_->objective.rounding() > 1e-12; }

    bool may_be_doubled() const { return automatic && in_float() && queue_.device().has_fp64(); }

    map coordinates() const
    {
        auto x = device_->numbers.undo(device_->objective.download(device_->x));
        for (vec<D>& p : x) p = (p + device_->centre) / of_.unit;
        return x;
    }

    /// The same, with fixed coordinates that equal their targets on the device set to the last bit.
    map placed() const
    {
        auto x = coordinates();
        fixed.impose(x, [this](std::size_t v) { return rounded(fixed.targets()[v]); });
        return x;
    }

    /// Certifies a map, with det of the elements in the user's lengths, too.
    certificate certified(const map& x) const;

    /// Untangling of a map with fixed coordinates at their targets, regardless of flips. guess: the map is injective
    /// without these.
    untangle_problem<Element> problem(const map& x, bool guess) const;

    /// Progress for the observer.
    progress seen() const;

private:
    struct state
    {
        permutation numbers;
        std::vector<idx> cells; ///< the user's numbers
        vec<D> centre{0.0};
        newton_objective<Element> objective;
        typename newton_objective<Element>::point x;
        bool single; ///< the precision of positions
        std::optional<solve::impl::prescribed_newton<newton_objective<Element>>> loading{};

        state(const queue& q, const mapped_mesh<Element>& of, const real_types& types)
            : state(q, of, types, mesh_levels<Element>(of.rest, {}, {}, of.data, {}, of.owners))
        {
        }
        state(const queue& q, const mapped_mesh<Element>& of, const real_types& types,
              const mesh_levels<Element>& levels)
            : numbers(levels.order().vertices),
              cells(levels.order().cells.new_to_old),
              objective(q,
                        {levels.make_layout(of.ideal), levels.cells(0), levels.transfers(0), levels.fixed(0),
                         lane_form::for_device(q.device())},
                        of.energy, of.weights, std::make_shared<const newton_kernels<Element>>(q, of.energy, types)),
              x(objective.make_point()),
              single(types.position == scalar_type::f32)
        {
        }
    };

    /// Tells the device the constraints, and where fixed coordinates are to go.
    void tell();

    /// Rounds a position as coordinates() would return it.
    vec<D> rounded(const vec<D>& p) const;

    queue queue_;
    const mapped_mesh<Element>& of_;
    std::vector<directed_spring<D>> springs_; ///< in normalised units
    std::optional<state> device_;
};

template <class Element>
void running_map<Element>::load(const map& x)
{
    auto& d = *device_;
    const map scaled = of_.scaled(x);
    d.centre = bounding_box<D>(scaled).centre;
    auto local = d.numbers.apply(scaled);
    for (vec<D>& p : local) p -= d.centre;
    d.objective.upload(local, d.x);
    tell();
}

template <class Element>
void running_map<Element>::constrain(const constraints<Element>& wanted)
{
    auto springs = point_constraints<D>{{}, directed(wanted.springs())}.scaled(of_.unit).springs;
    const bool other = fixed.take(wanted) || !springs.empty() || !springs_.empty();
    springs_ = std::move(springs);
    if (!loaded()) return;
    if (other)
        tell();
    else
        aim();
}

template <class Element>
template <class Target>
void running_map<Element>::aim(const Target& target)
{
    device_->objective.aim(
        [&, this](std::size_t v)
        {
            const vec<D> to = target(static_cast<std::size_t>(device_->numbers.new_to_old[v])) * of_.unit;
            return to - device_->centre;
        });
}

template <class Element>
solve::impl::prescribed_report
running_map<Element>::follow(double gap, const std::function<bool(const solve::impl::prescribed_report&)>& proceed)
{
    // Shapes in space are stretched on purpose, and a jam shows by crawling.
    auto& d = *device_;
    if (!d.loading) d.loading.emplace(d.objective, solve::impl::prescribed_params{.most_cost = D == 2 ? 10.0 : 1e4});
    return d.loading->run(d.x, gap, proceed);
}

template <class Element>
certificate running_map<Element>::certified(const map& x) const
{
    if constexpr (!Element::oriented)
        return certify_surface(of_.surface->cells(), of_.surface->points(), x);
    else
    {
        auto flips = certify<D>(of_.rest.cells(), std::span<const vec<D>>(x), of_.ideal.measure, 16, of_.owners);
        for (double* det : {&flips.min_det, &flips.max_det}) *det *= std::pow(of_.unit, D);
        return flips;
    }
}

template <class Element>
untangle_problem<Element> running_map<Element>::problem(const map& x, bool guess) const
{
    map there = x;
    fixed.impose(there);
    auto marks = fixed.marks();
    std::vector<idx> sliding;
    for (const auto& s : fixed.slides())
    {
        marks[static_cast<std::size_t>(s.vertex)] = marks.every; // while it untangles
        sliding.push_back(s.vertex);
    }
    return {of_.rest,          of_.scaled(std::move(there)),
            std::move(marks),  guess ? of_.scaled(x) : map(),
            of_.targets,       of_.owners,
            std::move(sliding)};
}

template <class Element>
progress running_map<Element>::seen() const
{
    if constexpr (D == 2)
        return {.coordinates = [this] { return coordinates(); }};
    else
        return {.positions = [this] { return coordinates(); }};
}

template <class Element>
void running_map<Element>::tell()
{
    auto c = point_constraints<D>{fixed.marks(), springs_, fixed.slides()}.renumbered(device_->numbers);
    for (auto& s : c.springs) s.target -= device_->centre;
    device_->objective.constrain(c);
    aim();
}

template <class Element>
auto running_map<Element>::rounded(const vec<D>& p) const -> vec<D>
{
    const double scale = device_->objective.layout().scale;
    vec<D> x = p * of_.unit;
    for (int k = 0; k < D; ++k)
    {
        const double local = x[k] - device_->centre[k];
        x[k] = (device_->single ? in_single(local * scale) / scale : local) + device_->centre[k];
    }
    return x / of_.unit;
}

// Compiled once, with the bodies.
extern template class running_map<triangle>;

} // namespace taut::impl
