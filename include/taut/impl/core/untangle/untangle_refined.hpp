// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/short_number.hpp>
#include <taut/impl/core/mesh/refine_elements.hpp>
#include <taut/impl/core/untangle/local_problem.hpp>
#include <taut/impl/core/untangle/proofs/mending_splits.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Transfers a problem to a refined mesh: new vertices are free and at the centres of the split simplices, target
/// shapes are those of the parent elements.
/// Throws parameter_error for cells that are corners of others (owners), which cannot be split.
template <class Element>
refined_problem<Element> refine_problem(const untangle_problem<Element>& p, const subdivision& how)
{
    constexpr int D = Element::dimension;
    if (!p.owners.empty()) throw parameter_error("owners", "cells that are not simplices cannot be split; triangulate");
    auto [rest, cells] = refine_elements(p.rest, how);
    auto bits = p.held.bits();
    bits.resize(static_cast<std::size_t>(how.vertex_count()), 0);
    const auto moved = [&](const std::vector<vec<D>>& x) { return how.extended(std::span<const vec<D>>(x)); };
    std::vector<mat<D>> wanted;
    if (!p.wanted.empty())
    {
        std::vector<double> parts(p.wanted.size(), 0.0);
        for (const idx c : cells) ++parts[static_cast<std::size_t>(c)];
        for (const idx c : cells)
        {
            const auto k = static_cast<std::size_t>(c);
            wanted.push_back(p.wanted[k] * std::pow(1 / parts[k], 1.0 / D)); // together they count as the whole
        }
    }
    refined_problem<Element> result{{std::move(rest), moved(p.initial), fixed_marks<D>(std::move(bits))}};
    if (!p.draft.empty()) result.problem.draft = moved(p.draft);
    result.problem.wanted = std::move(wanted);
    result.how = how;
    result.cells = std::move(cells);
    return result;
}

/// Splits simplices of the current problem; returns false, without effect, if that makes too many elements.
template <class Element>
bool split_further(refined_problem<Element>& now, const std::vector<std::vector<idx>>& simplices,
                   const refine_params& params)
{
    if (simplices.empty()) return false;
    subdivision step(now.problem.rest.vertex_count());
    for (const auto& s : simplices) step.split(s);
    auto next = refine_problem(now.problem, step);
    const double before = static_cast<double>(now.cells.back()) + 1;
    if (static_cast<double>(next.cells.size()) > params.max_growth * before) return false;
    next.how = std::move(now.how);
    for (const auto& s : simplices) next.how.split(s);
    for (idx& c : next.cells) c = now.cells[static_cast<std::size_t>(c)];
    next.rounds = now.rounds + 1;
    now = std::move(next);
    return true;
}

/// Refines an infeasible problem until no proof of infeasibility is found. Where that fails, `obstacle` says why.
/// Nothing is solved, and a problem without a proof is not changed.
template <class Element>
refined_problem<Element> refine_infeasible(const untangle_problem<Element>& problem, const refine_params& params = {})
{
    params.validate();
    auto now = refine_problem(problem, subdivision(problem.rest.vertex_count()));
    for (;;)
    {
        const auto proof = find_infeasibility(now.problem);
        if (!proof) return now;
        const auto splits = splits_against(now.problem, proof);
        if (!splits.obstacle.empty())
            now.obstacle = splits.obstacle + "; no split inside the mesh changes that";
        else if (now.rounds >= params.rounds)
            now.obstacle = proof.reason() + "; so after " + std::to_string(now.rounds) + " rounds of splits";
        else if (!impl::split_further(now, splits.simplices, params))
            now.obstacle = proof.reason() + "; splits would make more than " + impl::short_number(params.max_growth) +
                           " times as many elements";
        if (!now.obstacle.empty()) return now;
    }
}

/// Marks the vertices within a number of edges of cells. One flag per vertex.
template <class Element>
std::vector<char> within_rings(const mesh<Element>& m, std::span<const idx> cells, int rings)
{
    const auto at = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<char> inside(m.points().size(), 0);
    for (const idx c : cells)
        for (const idx v : m.cells()[at(c)]) inside[at(v)] = 1;
    for (; rings > 0; --rings)
    {
        const auto before = inside;
        for (const auto& t : m.cells())
            if (std::any_of(t.begin(), t.end(), [&](idx v) { return before[at(v)] != 0; }))
                for (const idx v : t) inside[at(v)] = 1;
    }
    return inside;
}

/// Replaces the best map, if another one has fewer defects.
template <class Element>
void take_better(const untangle_problem<Element>& p, std::vector<vec<Element::dimension>> map, const std::string& stage,
                 untangle_result<Element>& found)
{
    constexpr int D = Element::dimension;
    auto flips = certify<D>(p.rest.cells(), std::span<const vec<D>>(map), {}, p.rest.cells().size());
    if (flips.defects() >= found.flips.defects()) return;
    found.map = std::move(map);
    found.flips = std::move(flips);
    found.ids = found.flips.ids;
    found.stage = stage;
}

/// Stages of a short attempt: in space those that end soon.
template <class Element>
std::vector<std::string> quick_stages(const untangle_params& params, std::vector<std::string> in_space)
{
    return params.stages.empty() && Element::dimension == 3 ? std::move(in_space) : params.stages;
}

/// Untangles again from the best map so far.
template <class Element>
void untangle_again(const queue& q, refined_problem<Element>& now, const untangle_params& how, const run_limits& limits,
                    untangle_result<Element>& found)
{
    now.problem.initial = found.map;
    auto next = untangle(q, now.problem, how, limits);
    next.stages.insert(next.stages.begin(), found.stages.begin(), found.stages.end());
    if (next.stage == "initial") next.stage = found.stage; // there was nothing left to do
    found = std::move(next);
}

/// Untangles around the elements that are still inverted, with the rest of the map fixed. left: the present limits
template <class Element, class Left>
void untangle_around(const queue& q, untangle_problem<Element> p, untangle_params how, const Left& left,
                     untangle_result<Element>& found)
{
    how.stages = quick_stages<Element>(how, {"harmonic", "operator", "newton"});
    how.rounds = std::min(how.rounds, 2);
    for (const int rings : {2, 4, 8})
    {
        const run_limits limits = left();
        if (found.flips.flipped == 0 || !(limits.time_limit.count() > 0)) return;
        p.initial = found.map;
        const auto part = part_of(p, within_rings(p.rest, found.ids, rings));
        auto local = untangle(q, part ? part->problem : p, how, limits);
        found.stages.insert(found.stages.end(), local.stages.begin(), local.stages.end());
        auto map = part ? found.map : std::move(local.map);
        for (std::size_t k = 0; part && k < part->vertices.size(); ++k)
            map[static_cast<std::size_t>(part->vertices[k])] = local.map[k];
        take_better(p, std::move(map), local.stage, found);
        if (!part) return; // that was the whole
    }
}

} // namespace taut::impl
