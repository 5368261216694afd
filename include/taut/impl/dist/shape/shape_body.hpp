// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/solve/prescribed.hpp>
#include <taut/impl/dist/processes/agreed_limits.hpp>
#include <taut/impl/dist/shape/certify_part.hpp>
#include <taut/impl/dist/shape/gathered_solve.hpp>
#include <taut/impl/dist/shape/graph_partition.hpp>
#include <taut/impl/dist/shape/harmonic_guess.hpp>
#include <taut/impl/dist/shape/objective.hpp>
#include <taut/impl/dist/shape/rest_model.hpp>
#include <taut/minimize.hpp>

namespace taut::dist::impl
{

/// A deforming shape over many processes: what a session keeps between its calls. All functions are collective.
template <class Element>
class shape_body
{
public:
    static constexpr int D = Element::dimension;
    using numbers = std::vector<double>; ///< D a vertex
    using points = std::vector<vec<D>>;

    shape_body(const communicator& all, const mesh_piece<Element>& piece, const deform_params<Element>& params)
        : petsc_(std::make_unique<petsc_scope>()),
          params_(checked(all, params)),
          part_(made_part(all, piece)),
          rest_(part_, params_),
          held_(part_),
          multigrid_(all, params_.solver)
    {
        const auto timed = clock_.measure(&phase_seconds::distribute);
        const auto here = rank_on_machine(all);
        all.together(
            [&]
            {
                if (!rest_.l) return;
                elements_ = local_elements<Element>(params_.queue ? *params_.queue : open_own_queue(here), rest_.l,
                                                    part_.corners, part_.own, rest_.weights, rest_.model);
            });
        objective_ = std::make_unique<dist_objective<Element>>(part_, elements_, held_, multigrid_, clock_);
        const bool single = rest_.model.types.vector == scalar_type::f32;
        objective_->set_scales(rest_.gradient_scale, taut::impl::characteristic_value<D>(rest_.model.energy),
                               single ? 1e-8 : 1e-14);
        objective_->set_lengths(rest_.lengths);
        x_ = start(piece);
        constrain(params_.constraints);
        petsc_.reset();
    }

    /// Replaces the constraints. Throws constraint_error.
    void constrain(const constraints<Element>& wanted)
    {
        const petsc_scope petsc;
        const auto before = held_.marks;
        held_.take(part_, wanted);
        changed_ = true;
        const bool others = part_.all.any(before != held_.marks);
        rows_stale_ = rows_stale_ || others;
    }

    /// Fixes directions of owned vertices: projections of displacements, one a vertex of the part.
    void slide(std::vector<mat<D>> projections)
    {
        held_.slides = std::move(projections);
        origin_ = x_;
        rows_stale_ = true;
    }

    /// Tells reports how many vertices inside keep to interfaces.
    void keep_to_interfaces(std::int64_t count) { on_interfaces_ = count; }

    const part<Element>& mesh_part() const { return part_; }
    const rest_model<Element>& at_rest() const { return rest_; }
    dist_objective<Element>& objective() { return *objective_; }
    const numbers& current() const { return x_; }
    local_elements<Element>& elements() { return elements_; }

    report solve(const run_limits& limits)
    {
        const petsc_scope petsc;
        agreed_limits clock(part_.all, limits);
        report r;
        r.on_interfaces = on_interfaces_;
        r.flips = certified(x_);
        if (!r.flips)
        {
            r.outcome = outcome::gave_up;
            r.ids = r.flips.ids.empty() ? r.flips.branch_ids : r.flips.ids;
            r.reason = "the shape to begin with has " + defects(r.flips) +
                       "; untangle it on one machine first, or begin with another";
            return finished(std::move(r));
        }
        last_ = x_;
        r.outcome = outcome::valid;
        prepare();
        if (const auto pinned = pinned_inverted(part_, held_, aimed_); pinned.flipped > 0)
        {
            r.outcome = outcome::infeasible;
            r.ids = pinned.ids;
            r.reason = defects(pinned) + " with all vertices pinned; move or free a vertex of each";
            r.distance = gap(x_, aimed_) / rest_.lengths;
            return finished(std::move(r));
        }
        if (clock.proceed())
        {
            bool arrived = !apart();
            if (!arrived) arrived = follow(clock, r);
            if (arrived && clock.proceed()) minimise(clock, r);
        }
        take(r);
        r.stopped = clock.over() || (!r.converged && stopped_by_steps_);
        settle(r);
        return finished(std::move(r));
    }

    /// The last certified shape at the caller's vertices.
    points answer() const
    {
        numbers own(static_cast<std::size_t>(D) * part_.own);
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = x_[i] / rest_.lengths;
        const auto flat = part_.answer(own, D);
        points result(flat.size() / D);
        for (std::size_t v = 0; v < result.size(); ++v)
            for (int k = 0; k < D; ++k) result[v][k] = flat[D * v + static_cast<std::size_t>(k)];
        return result;
    }

private:
    static constexpr int longest_system = 400; ///< products: of slivers; short ones would lead nowhere

    static deform_params<Element> checked(const communicator& all, const deform_params<Element>& params)
    {
        all.together([&] { params.validate(); });
        return params;
    }

    part<Element> made_part(const communicator& all, const mesh_piece<Element>& piece)
    {
        const auto timed = clock_.measure(&phase_seconds::distribute);
        part<Element> made(all, piece);
        if (params_.solver.partition == partition::curve || all.size() == 1) return made;
        return part<Element>(made, piece, scotch_owners(made));
    }

    /// Positions to begin with, in lengths of the run.
    numbers start(const mesh_piece<Element>& piece)
    {
        numbers x(static_cast<std::size_t>(D) * part_.size());
        for (std::size_t v = 0; v < part_.size(); ++v)
            for (int k = 0; k < D; ++k) x[D * v + static_cast<std::size_t>(k)] = part_.points[v][k] * rest_.lengths;
        if (!part_.all.any(!params_.initial.empty())) return x;
        part_.all.together(
            [&]
            {
                if (params_.initial.size() != piece.ids.size())
                    throw parameter_error("initial", std::to_string(params_.initial.size()) + " positions for " +
                                                         std::to_string(piece.ids.size()) + " vertices");
                for (const auto& p : params_.initial)
                    for (int k = 0; k < D; ++k)
                        if (!std::isfinite(p[k])) throw parameter_error("initial", "has a number that is not finite");
            });
        struct placed
        {
            std::int64_t place;
            vec<D> x;
        };
        parcels<placed> to(part_.all.ranks());
        const auto numbered = part_.find(piece.ids);
        for (std::size_t i = 0; i < numbered.size(); ++i)
        {
            const auto at = part_.place_of(numbered[i]);
            to[at.rank].push_back({at.place, params_.initial[i]});
        }
        for (const auto& [place, p] : part_.all.exchange(to).items)
            for (int k = 0; k < D; ++k) x[static_cast<std::size_t>(D * place + k)] = p[k] * rest_.lengths;
        part_.update(x, D);
        params_.initial = {};
        return x;
    }

    void prepare()
    {
        if (rows_stale_) objective_->rows_changed();
        rows_stale_ = false;
        aimed_ = scaled(held_.targets);
        objective_->aim(aimed_);
        changed_ = false;
    }

    numbers scaled(numbers x) const
    {
        for (double& k : x) k *= rest_.lengths;
        return x;
    }

    certificate certified(const numbers& x)
    {
        const auto timed = clock_.measure(&phase_seconds::certify);
        return certify_part(part_, x, rest_.measure);
    }

    static std::string defects(const certificate& c)
    {
        const auto list = [](std::int64_t n, const std::string& things, const std::vector<std::int64_t>& ids)
        {
            std::string text = std::to_string(n) + ' ' + things + " (";
            const std::size_t shown = std::min<std::size_t>(5, ids.size());
            for (std::size_t k = 0; k < shown; ++k) text += (k ? ", " : "") + std::to_string(ids[k]);
            return text + (static_cast<std::int64_t>(shown) < n ? ", ...)" : ")");
        };
        if (c.flipped > 0)
            return list(c.flipped,
                        c.flipped == 1 ? std::string("inverted ") + Element::name
                                       : std::string("inverted ") + Element::names,
                        c.ids);
        return list(c.branched, D == 2 ? "vertices wound around twice" : "edges wound around twice, of vertices",
                    c.branch_ids);
    }

    /// Distance of the vertex that is farthest from its target, in lengths of the run.
    double gap(const numbers& x, const numbers& to) const
    {
        double most = 0;
        for (std::size_t v = 0; v < part_.own; ++v)
        {
            double square = 0;
            for (int k = 0; k < D; ++k)
                if (held_.held(v, k))
                {
                    const auto i = D * v + static_cast<std::size_t>(k);
                    square += (to[i] - x[i]) * (to[i] - x[i]);
                }
            most = std::max(most, square);
        }
        return std::sqrt(part_.all.most(most));
    }
    bool apart() const { return gap(x_, aimed_) > 0; }

    /// Brings fixed coordinates to their targets: by an initial guess where bodies rotate, else, or where that inverts
    /// elements, step by step in parts.
    bool follow(agreed_limits& clock, report& r)
    {
        const pinned_bodies<Element> bodies(part_, held_, x_, rest_.lengths);
        if (bodies.parts() > 1 && start_from_guess(bodies)) return true;
        if (follow_parts(bodies, clock, r)) return true;
        constexpr std::int64_t most = 200000; // vertices, whose factors fit into memory
        if (!clock.over() && objective_->unknowns() <= most && multigrid_.use_factors())
        {
            // Directions of multigrid may be too coarse for slivers.
            r.notes.push_back("steps stuck; from there on systems are solved by factorisation");
            r.reason.clear();
            if (follow_parts(pinned_bodies<Element>(part_, held_, x_, rest_.lengths), clock, r)) return true;
        }
        return !clock.over() && gather(clock, r);
    }

    /// Leaves it to process 0, where the mesh is not too large for that.
    bool gather(agreed_limits& clock, report& r)
    {
        using gathered = gathered_solve<Element>;
        if (part_.cells > gathered::most_cells || !held_.slides.empty()) return false;
        const auto found = gathered::run(part_, held_, rest_.lengths, params_, x_, clock.left());
        if (!clock.proceed() || !found) return false;
        x_ = found->x;
        objective_->put(x_);
        r.steps += found->steps;
        r.notes.push_back("steps stuck; process 0 gathered the mesh and brought the pins to their places by itself");
        r.reason.clear();
        return !apart();
    }

    bool follow_parts(const pinned_bodies<Element>& bodies, agreed_limits& clock, report& r)
    {
        if (!steps_)
            steps_.emplace(*objective_,
                           solve::impl::prescribed_params{.pcg = {.max_steps = longest_system, .gain = 0.01},
                                                          .most_cost = D == 2 ? 10.0 : 1e4});
        const int parts = bodies.parts();
        bool arrived = true;
        for (int k = 1; k <= parts && arrived; ++k)
        {
            if (k > 1 && !clock.proceed()) return false;
            const auto way = bodies.places(static_cast<double>(k) / parts);
            objective_->aim(way);
            const double left = gap(x_, way);
            if (!(left > 0)) continue;
            const auto found =
                steps_->run(x_, left,
                            [&](const solve::impl::prescribed_report& at)
                            { return clock.proceed({.iteration = r.steps + at.iterations, .value = at.value}); });
            r.steps += found.iterations;
            r.products += found.products;
            r.energy = found.value;
            arrived = found.arrived;
        }
        objective_->aim(aimed_);
        if (!arrived && !clock.over()) r.reason = "steps lead no nearer to the pins";
        return arrived;
    }

    /// Returns whether the guess was taken: no element is inverted or nearly flat.
    bool start_from_guess(const pinned_bodies<Element>& bodies)
    {
        const auto timed = clock_.measure(&phase_seconds::start);
        bool partial = !held_.slides.empty();
        for (std::size_t v = 0; v < part_.own; ++v) partial = partial || (held_.marks[v] != 0 && !held_.pinned(v));
        if (part_.all.any(partial)) return false;
        const harmonic_guess<Element> guess(part_, held_, elements_.pattern(), x_);
        auto x = guess(bodies, x_);
        constexpr double flat = 0.03; // such elements would cut the steps of all for long
        if (guess.shrinks(x, flat)) return false;
        objective_->put(x);
        if (!certified(x)) return false;
        x_ = std::move(x);
        return true;
    }

    void minimise(agreed_limits& clock, report& r)
    {
        auto how = params_.solve;
        // Set-ups of the preconditioner cost as much as ten products, so directions are more exact than elsewhere.
        how.tuning.newton.pcg.gain = std::min(how.tuning.newton.pcg.gain, 0.05);
        how.tuning.newton.pcg.max_steps = std::max(how.tuning.newton.pcg.max_steps, longest_system / 4);
        const int before = r.steps;
        const auto ask = [&](progress p)
        {
            p.iteration += before;
            return clock.proceed(p);
        };
        const auto found = solve::minimize(*objective_, x_, how, {.observer = ask}); // no time limit: clocks differ
        r.steps += found.iterations;
        r.products += found.products;
        r.energy = found.value;
        r.gradient = found.gradient_norm;
        r.converged = solve::impl::converged(found.stop);
        stopped_by_steps_ = found.stop == solve::stop::iterations;
        if (!r.converged && !clock.over())
            r.notes.push_back("steps ended before convergence: " + std::string(to_string(found.stop)));
    }

    /// Accepts the shape if it is certified; else the last one is restored.
    void take(report& r)
    {
        if (!held_.slides.empty())
        {
            for (std::size_t v = 0; v < part_.size(); ++v)
            {
                vec<D> d;
                for (int k = 0; k < D; ++k)
                    d[k] = x_[D * v + static_cast<std::size_t>(k)] - origin_[D * v + static_cast<std::size_t>(k)];
                d = held_.slides[v] * d;
                for (int k = 0; k < D; ++k)
                    if (!held_.held(v, k))
                        x_[D * v + static_cast<std::size_t>(k)] = origin_[D * v + static_cast<std::size_t>(k)] + d[k];
            }
        }
        auto flips = certified(x_);
        if (flips)
        {
            r.flips = std::move(flips);
            last_ = x_;
            return;
        }
        r.notes.push_back("in exact arithmetic the shape had " + defects(flips) + "; the last one is returned");
        r.converged = false;
        x_ = last_;
    }

    /// The outcome by the pins.
    void settle(report& r)
    {
        const double left = gap(x_, aimed_) / rest_.lengths;
        r.pins_held = left == 0;
        r.distance = left;
        if (r.pins_held) return;
        r.converged = false;
        r.outcome = r.stopped ? outcome::stopped : outcome::gave_up;
        if (r.reason.empty())
            r.reason = "a vertex is " + std::to_string(left) + " from its place" +
                       (r.stopped ? "; give it more time" : "; no path there was found");
    }

    report finished(report r)
    {
        r.setups = multigrid_.setups();
        r.fallbacks = multigrid_.fallbacks();
        if (r.fallbacks > 0)
            r.notes.push_back("a preconditioner failed, and a safer one took its place, " +
                              std::to_string(r.fallbacks) + (r.fallbacks == 1 ? " time" : " times"));
        std::string unused;
        for (const auto& name : multigrid_.unused()) unused += (unused.empty() ? "" : ", ") + name;
        if (!unused.empty()) r.notes.push_back("PETSc made no use of the options " + unused);
        r.unknowns = objective_->unknowns();
        r.seconds = clock_.spent();
        r.own_vertices = static_cast<std::int64_t>(part_.own);
        r.halo_vertices = static_cast<std::int64_t>(part_.size() - part_.own);
        r.local_cells = static_cast<std::int64_t>(part_.corners.size());
        r.device_bytes = elements_.bytes();
        return r;
    }

    phase_clock clock_;
    std::unique_ptr<petsc_scope> petsc_;
    deform_params<Element> params_;
    part<Element> part_;
    rest_model<Element> rest_;
    fixed_part<Element> held_;
    local_elements<Element> elements_;
    algebraic_multigrid multigrid_;
    std::unique_ptr<dist_objective<Element>> objective_;
    std::optional<solve::impl::prescribed_newton<dist_objective<Element>>> steps_;
    numbers x_, last_, origin_, aimed_; ///< the shape, the last certified one, where slides begin, targets
    bool changed_ = true, rows_stale_ = true, stopped_by_steps_ = false;
    std::int64_t on_interfaces_ = 0;
};

} // namespace taut::dist::impl
