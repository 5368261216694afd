// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/compute/queue.hpp>
#include <taut/constrain/held_paths.hpp>
#include <taut/constrain/untangle_problem.hpp>
#include <taut/core/budget.hpp>
#include <taut/exact/certify.hpp>
#include <taut/map/deform_params.hpp>
#include <taut/map/detail/gradient_fit.hpp>
#include <taut/map/detail/shape_path.hpp>
#include <taut/measure/rigid_motion.hpp>
#include <taut/mesh/incidence.hpp>
#include <taut/untangle/detail/local_problem.hpp>
#include <taut/untangle/device/live_map.hpp>
#include <taut/untangle/untangle.hpp>

namespace taut::detail
{

/// A shape whose held coordinates are at their places, where bodies of held vertices turn on the way: turns, axis times
/// angle, are harmonic between those of the bodies, and gradients nearest to the turns of the elements (Zayer et al.
/// 2005, "Harmonic guidance for surface deformation"). Elements may be inverted, where turns change fast.
/// from: the shape at hand, no element inverted; to: the places, of which held coordinates are read.
inline std::vector<vec3> turned_draft(const gradient_fit<tetrahedron>& poisson, const mesh<tetrahedron>& m,
                                      const held_paths<3>& paths, const held_marks<3>& marks,
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
    held_marks<3> told(from.size());
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
    constexpr double enough = 1e-2; // a draft
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

/// A shape with held coordinates at their places, and what it took.
struct mended_draft
{
    std::vector<vec3> x;                       ///< certified; empty: none was found
    int steps = 0;                             ///< of Newton's method on a part of the mesh
    std::size_t vertices = 0;                  ///< of that part
    std::vector<untangle_stage_report> stages; ///< of its untangling
};

/// Whether a gradient inverts, or shrinks to less than `least` in some direction.
inline bool shrinks(const mat3& F, double least)
{
    return !(glm::determinant(F) > 0 && norm2(glm::inverse(F)) < 2 + 1 / (least * least));
}

/// One flag a vertex: it is at most four edges from an element that is inverted, or has shrunk to less than 0.3 in some
/// direction; nothing where there is no such element.
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

/// The shape at hand, which is injective (`draft` of the problem), with held vertices at their places (`initial`), to
/// which bodies of them turn: a turned_draft. What has shrunk there, with its neighbours, is untangled and minimised by
/// itself, with the shape at hand as that at rest: else such elements, though few, would cut the steps of all.
inline mended_draft draft_of(const queue& q, const untangle_problem<tetrahedron>& problem, const held_paths<3>& paths,
                             untangle_params how, precision arithmetic)
{
    const budget clock(how.time_limit);
    const mesh<tetrahedron> here(problem.draft, problem.rest.cells());
    const gradient_fit<tetrahedron> poisson(here, problem.draft);
    mended_draft found{.x = turned_draft(poisson, here, paths, problem.held, problem.draft, problem.initial)};
    const auto certified = [](const mesh<tetrahedron>& m, const std::vector<vec3>& x)
    { return bool(certify<3>(m.cells(), std::span<const vec3>(x))); };
    const auto none = [&]
    {
        found.x.clear();
        return found;
    };
    if (const auto inside = around_shrunk(poisson, here, found.x); !inside.empty())
    {
        const auto part = part_of<tetrahedron>({here, found.x, problem.held, {}, {}, problem.owners}, inside);
        if (!part || !clock.in_time()) return none();
        found.vertices = part->vertices.size();
        auto start = part->problem.initial;
        if (!certified(part->problem.rest, start))
        {
            how.rounds = 1;
            how.stages = {"lead"}; // others leave elements next to flat, which cut the steps that follow
            how.time_limit = clock.left();
            auto untangled = untangle(q, part->problem, how);
            found.stages = std::move(untangled.stages);
            if (!untangled || !clock.in_time()) return none();
            start = std::move(untangled.map);
        }
        live_map<tetrahedron> live(q, part->problem.rest, deform_params<tetrahedron>{}, arithmetic, start);
        live.constrain(part->problem.held, {}, {});
        const solve::stopping_params enough{
            .gradient_tolerance = 1e-3, .max_iterations = 30, .time_limit = clock.left()};
        found.steps = live.minimize({.stopping = enough}, how.observer).iterations;
        const auto mended = live.coordinates();
        for (std::size_t k = 0; k < mended.size(); ++k)
            for (int i = 0; i < 3; ++i)
                if (!part->problem.held.test(k, i))
                    found.x[static_cast<std::size_t>(part->vertices[k])][i] = mended[k][i];
    }
    constexpr double flat = 0.03; // such elements would cut the steps of all for long
    for (std::size_t c = 0; c < here.cells().size(); ++c)
        if (shrinks(poisson.gradient(c, found.x), flat)) return none();
    return certified(here, found.x) ? found : none();
}

} // namespace taut::detail
