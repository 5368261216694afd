// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/constrain/prescribed_paths.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/objective/running_map.hpp>
#include <taut/impl/core/start/coarse_guess.hpp>
#include <taut/impl/core/start/gradient_fit.hpp>
#include <taut/impl/core/start/shape_path.hpp>
#include <taut/impl/core/untangle/local_problem.hpp>
#include <taut/queue.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/untangle.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Initial guess with fixed coordinates at their targets, where bodies of fixed vertices rotate, by harmonic guidance:
/// rotations, axis times angle, are harmonic between those of the bodies, and gradients nearest to the rotations of the
/// elements (Zayer et al. 2005, "Harmonic guidance for surface deformation"). Elements may be inverted, where turns
/// change fast.
/// from: the current shape, no element inverted; to: the targets, of which fixed coordinates are read.
inline std::vector<vec3> harmonic_guess(const gradient_fit<tetrahedron>& poisson, const mesh<tetrahedron>& m,
                                        const prescribed_paths<3>& paths, const fixed_marks<3>& marks,
                                        const std::vector<vec3>& from, const std::vector<vec3>& to)
{
    std::vector<vec3> held, places;
    for (std::size_t v = 0; v < from.size(); ++v)
        if (marks.all(v))
        {
            held.push_back(from[v]);
            places.push_back(to[v]);
        }
    const auto whole = fit_rigid_motion(std::span<const vec3>(held), std::span<const vec3>(places));
    std::vector<vec3> turns(from.size(), whole.angle * whole.axis), x;
    fixed_marks<3> told(from.size());
    for (std::size_t v = 0; v < from.size(); ++v)
    {
        x.push_back(whole(from[v]));
        for (int k = 0; k < 3; ++k)
            if (marks.test(v, k)) x[v][k] = to[v][k];
        if (const auto turn = paths.turn(v))
        {
            turns[v] = *turn;
            told[v] = told.every;
        }
    }
    constexpr double enough = 1e-2; // an initial guess
    poisson.fit([](std::size_t) { return mat3(0.0); }, told, enough, turns);
    const auto wanted = [&](std::size_t c)
    {
        vec3 mean(0.0);
        for (const idx v : m.cells()[c]) mean += turns[static_cast<std::size_t>(v)] / 4.0;
        return rotation<3>(mean);
    };
    poisson.fit(wanted, marks, enough, x);
    return x;
}

/// Shape with fixed coordinates at their targets, and its report.
struct mended_guess
{
    std::vector<vec3> x;                       ///< certified; empty: none was found
    int steps = 0;                             ///< of Newton's method on coarser volumes and on parts
    std::size_t vertices = 0;                  ///< of the part of the mesh itself
    std::vector<untangle_stage_report> stages; ///< of untanglings
};

/// Returns whether a gradient inverts, or shrinks to less than `least` in some direction.
inline bool shrinks(const mat3& F, double least)
{
    return !(glm::determinant(F) > 0 && norm2(glm::inverse(F)) < 2 + 1 / (least * least));
}

/// One flag per vertex: it is at most four edges from an element that is inverted, or has shrunk to less than 0.3 in
/// some direction; nothing where there is no such element.
inline std::vector<char> around_shrunk(const gradient_fit<tetrahedron>& poisson, const mesh<tetrahedron>& m,
                                       const std::vector<vec3>& x)
{
    constexpr double least = 0.3;
    const auto at = [](idx v) { return static_cast<std::size_t>(v); };
    std::vector<char> inside(x.size(), 0);
    bool any = false;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        if (!shrinks(poisson.gradient(c, x), least)) continue;
        any = true;
        for (const idx v : m.cells()[c]) inside[at(v)] = 1;
    }
    if (!any) return {};
    const csr neighbours = vertex_neighbours(m);
    for (int ring = 0; ring < 4; ++ring)
    {
        const auto before = inside;
        for (idx v = 0; v < m.vertex_count(); ++v)
            if (before[at(v)])
                for (const idx w : neighbours.row(v)) inside[at(w)] = 1;
    }
    return inside;
}

/// Initial guess of one problem, and what its levels share.
class guess_maker
{
public:
    using problem = untangle_problem<tetrahedron>;

    guess_maker(const queue& q, const run_limits& limits, precision arithmetic)
        : queue_(q), clock_(limits.time_limit), ask_(limits.observer), arithmetic_(arithmetic)
    {
    }

    /// Predicts a shape from the current one, which is injective (`draft` of the problem), with fixed vertices at their
    /// targets (`initial`), to which they move: that of a coarser volume, where there is one, or else harmonic
    /// guidance, where bodies of them rotate. Shrunk elements, with their neighbours, are untangled and minimised
    /// separately, with the current shape as rest shape: else such elements, though few, would cut the steps of all.
    mended_guess make(const problem& p) const
    {
        const mesh<tetrahedron> here(p.draft, p.rest.cells());
        const gradient_fit<tetrahedron> poisson(here, p.draft);
        mended_guess found = from_coarser(p, here, poisson);
        if (!found.x.empty() && mend(p, here, poisson, found)) return found;
        const prescribed_paths<3> paths(p.rest.cells(), p.held, p.draft, p.initial);
        if (paths.parts() == 1 || !clock_.in_time()) return without_shape(found);
        found.x = harmonic_guess(poisson, here, paths, p.held, p.draft, p.initial);
        return mend(p, here, poisson, found) ? found : without_shape(found);
    }

private:
    static mended_guess without_shape(mended_guess found)
    {
        found.x.clear();
        return found;
    }

    static bool certified(const problem& p, const std::vector<vec3>& x)
    {
        return bool(certify<3>(p.rest.cells(), std::span<const vec3>(x), {}, 0, p.owners));
    }

    /// Prolongs the minimum on a coarser volume: the buckling direction of limbs is decided there, which takes many
    /// steps, whatever the size.
    mended_guess from_coarser(const problem& p, const mesh<tetrahedron>& here,
                              const gradient_fit<tetrahedron>& poisson) const
    {
        const auto smaller = coarser(p, clock_);
        if (!smaller) return {};
        const problem& small = smaller->problem;
        mended_guess found = make(small);
        if (found.x.empty() && clock_.in_time()) found.x = untangled(small, found);
        if (found.x.empty() || !clock_.in_time()) return without_shape(found);
        constexpr double nearly = 1e-6; // before that limbs may still buckle
        minimise(small, nearly, 60, found);
        found.vertices = 0;
        found.x = prolonged_guess(poisson, here, smaller->thinned, found.x, p.held, p.initial);
        return found;
    }

    /// Untangles and minimises shrunk elements; returns whether the shape is good then.
    bool mend(const problem& p, const mesh<tetrahedron>& here, const gradient_fit<tetrahedron>& poisson,
              mended_guess& found) const
    {
        if (const auto inside = around_shrunk(poisson, here, found.x); !inside.empty())
        {
            const auto part = part_of<tetrahedron>({here, found.x, p.held, {}, {}, p.owners}, inside);
            if (!part) return false;
            found.vertices = part->vertices.size();
            mended_guess mended;
            mended.x = part->problem.initial;
            if (!certified(part->problem, mended.x)) mended.x = untangled(part->problem, found);
            if (mended.x.empty() || !clock_.in_time()) return false;
            minimise(part->problem, 1e-3, 30, mended);
            found.steps += mended.steps;
            for (std::size_t k = 0; k < mended.x.size(); ++k)
                for (int i = 0; i < 3; ++i)
                    if (!part->problem.held.test(k, i))
                        found.x[static_cast<std::size_t>(part->vertices[k])][i] = mended.x[k][i];
        }
        constexpr double flat = 0.03; // such elements would cut the steps of all for long
        for (std::size_t c = 0; c < here.cells().size(); ++c)
            if (shrinks(poisson.gradient(c, found.x), flat)) return false;
        return certified(p, found.x);
    }

    /// Untangles to an injective map, or none.
    std::vector<vec3> untangled(const problem& p, mended_guess& booked) const
    {
        // Other stages leave elements next to flat, which cut the steps that follow.
        auto result = untangle(queue_, p, {.stages = {"lead"}, .rounds = 1}, {clock_.left(), ask_});
        booked.stages.insert(booked.stages.end(), result.stages.begin(), result.stages.end());
        return result ? std::move(result.map) : std::vector<vec3>();
    }

    /// Minimises the shape to a relative gradient, with a maximum number of steps.
    void minimise(const problem& p, double gradient, int steps, mended_guess& found) const
    {
        const mapped_mesh<tetrahedron> of{.rest = p.rest};
        running_map<tetrahedron> running(queue_, of);
        running.fixed = {p.held, p.initial};
        running.load(found.x, arithmetic_);
        const solve::params enough{.gradient_tolerance = gradient, .max_iterations = steps};
        found.steps += running.minimise(enough, {clock_.left(), ask_}).iterations;
        found.x = running.coordinates();
    }

    queue queue_;
    budget clock_;
    observer ask_;
    precision arithmetic_;
};

} // namespace taut::impl
