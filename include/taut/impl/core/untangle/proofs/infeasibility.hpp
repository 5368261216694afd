// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/core/name_in.hpp>
#include <taut/impl/core/mesh/describe.hpp>

namespace taut::impl
{

/// Kinds of proof that pins admit no map of positive elements. The comment says what the ids of a finding are.
enum class infeasibility_kind
{
    inverted_element, ///< elements with all vertices pinned, of negative or no measure
    flat_element,     ///< elements that fixed coordinates make flat, whatever the others are
    empty_star,       ///< a free vertex and elements around it that contradict each other, three triangles or four
                      ///< tetrahedra, the last one repeated where fewer do; four or five ids each
    wound_star,       ///< pinned inner vertices whose neighbours are pinned and run around them more than once
    outline_measure,  ///< vertices of a pinned outline of negative or no area (in order) or volume (three a face)
    outline_turning,  ///< vertices of a pinned outline that turns less often than that of any surface, in order
    outline_winding,  ///< vertices of a pinned outline that runs clockwise around some point, in order
    outside_boundary, ///< pinned inner vertices that their pinned boundary does not wind about
    crossing_edges, ///< pairs of edges between pinned vertices that meet within a simple pinned boundary; four ids each
    crowded_edge,   ///< an edge without a direction, two vertices, then the tetrahedra that say so
    /// A warning: pairs of edges between pinned vertices that meet, four ids each. Elements can all be positive, but
    /// the map is not one-to-one.
    not_globally_injective
};

/// Stable identifier of a kind, for programs.
constexpr const char* to_string(infeasibility_kind kind)
{
    return taut::impl::name_in<infeasibility_kind::not_globally_injective>(
        {"inverted_element", "flat_element", "empty_star", "wound_star", "outline_measure", "outline_turning",
         "outline_winding", "outside_boundary", "crossing_edges", "crowded_edge", "not_globally_injective"},
        kind);
}

/// One proof or warning, with the ids it concerns, and a sentence with the remedy.
struct infeasibility_finding
{
    infeasibility_kind kind;
    std::vector<idx> ids; ///< 0-based; which: see infeasibility_kind
    std::string message;
};

/// Proof that pins are infeasible, found before anything is solved.
struct infeasibility
{
    using enum infeasibility_kind; // so that a kind is proof.empty_star, say

    std::vector<infeasibility_finding> proofs;   ///< each is enough: no map is locally injective
    std::vector<infeasibility_finding> warnings; ///< properties that no map with these pins has

    /// True if infeasibility is proved.
    explicit operator bool() const { return !proofs.empty(); }

    /// The first proof in words; empty if there is none.
    std::string reason() const { return proofs.empty() ? std::string() : proofs.front().message; }

    /// Adds a proof if there are ids; say(ids) puts it in words.
    template <class Say>
    void prove(infeasibility_kind kind, std::vector<idx> ids, const Say& say)
    {
        if (ids.empty()) return;
        std::string message = say(ids);
        proofs.push_back({kind, std::move(ids), std::move(message)});
    }
};

} // namespace taut::impl
