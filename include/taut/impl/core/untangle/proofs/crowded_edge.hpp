// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/impl/core/untangle/proofs/side_view.hpp>
#include <taut/impl/core/untangle/proofs/vanishing_sum.hpp>

/// Proof test: whether an inner edge has a direction for which the tetrahedra around it can be positive.
namespace taut::impl
{

/// Returns the same corners with the opposite orientation.
inline side_view::tetra mirrored(const side_view::tetra& t)
{
    return {t[1], t[0], t[2], t[3]};
}

/// Cases of the corners q around an edge of four positive tetrahedra as seen from u, one of its ends: sets of
/// tetrahedra of one of which all are positive. Either the two on one of the diagonals of q are, or three of the four
/// on diagonals are negative. For let w be the other end, and let weights m, by sign those of [q1 q2 q3], -[q0 q2 q3],
/// [q0 q1 q3], -[q0 q1 q2], make the sum of the q - u vanish. So do they in the plane across w - u, where the q run
/// once around 0 in steps of less than half a turn: sums of neighbours lie in sectors that do not overlap, so
/// neighbours cannot have the one sign and the two others the other one. (None is flat: where all that is to be
/// positive can be, it can be with any of the free vertices moved a little.)
inline std::vector<std::vector<side_view::tetra>> cases_around(idx u, const std::array<idx, 4>& q)
{
    const side_view::tetra a{u, q[0], q[1], q[2]}, b{u, q[0], q[2], q[3]}, c{u, q[1], q[2], q[3]},
        d{u, q[0], q[1], q[3]};
    const auto not_a = mirrored(a), not_b = mirrored(b), not_c = mirrored(c), not_d = mirrored(d);
    return {{a, b}, {c, d}, {not_a, not_b, not_c}, {not_a, not_b, not_d}, {not_c, not_d, not_a}, {not_c, not_d, not_b}};
}

/// Polynomials of an edge and a third vertex, all to be positive.
class place_system
{
public:
    /// Sums that are known to vanish, by the factors of their terms.
    using relations = std::set<std::vector<std::array<const place_form*, 2>>>;

    /// known is referred to, and added to.
    explicit place_system(relations& known) : known_(&known) {}

    void add(const place_form& f)
    {
        if (f.degree == 1) linear_.push_back(&f);
        if (f.degree == 2) bilinear_.push_back(&f);
    }

    /// Removes linear forms that follow from others.
    void thin()
    {
        for (std::size_t i = 0; i < linear_.size();)
        {
            const place_form* f = linear_[i];
            linear_.erase(linear_.begin() + static_cast<std::ptrdiff_t>(i));
            if (!follows(*f)) linear_.insert(linear_.begin() + static_cast<std::ptrdiff_t>(i++), f);
        }
    }

    /// Vanishing sum of linear forms, up to rounding.
    bool follows(const place_form& f) const
    {
        std::vector<std::vector<double>> columns;
        for (const auto* g : linear_) columns.push_back(g->rounded);
        return fit_nonnegative(columns, f.rounded).error() < 1e-9;
    }

    /// True if they contradict each other, one more linear one included: a sum of products of linear ones and of
    /// bilinear ones, with weights that are not negative, vanishes. Exact.
    bool contradictory(const place_form* more = nullptr)
    {
        auto linear = linear_;
        if (more) linear.push_back(more);
        std::vector<std::vector<double>> columns;
        std::vector<std::array<const place_form*, 2>> factors;
        for (std::size_t i = 0; i < linear.size(); ++i)
            for (std::size_t j = i; j < linear.size(); ++j)
            {
                columns.push_back(rounded_product(*linear[i], *linear[j]));
                factors.push_back({linear[i], linear[j]});
            }
        for (const auto* f : bilinear_)
        {
            columns.push_back(f->rounded);
            factors.push_back({f, nullptr});
        }
        for (const auto& w : witnesses_)
            if (std::all_of(columns.begin(), columns.end(), [&](const auto& c) { return times(w, c) > 1e-9; }))
                return false;
        for (auto& c : columns) c.push_back(1); // the weights sum to 1
        std::vector<double> target(side_view::products + 1, 0.0);
        target.back() = 1;
        auto fit = fit_nonnegative(columns, target);
        if (fit.error() > 1e-6)
        {
            // What is left says of values for the products, though perhaps of no places, that make all positive.
            fit.rest.pop_back();
            for (double& x : fit.rest) x = -x;
            witnesses_.push_back(std::move(fit.rest));
            return false;
        }
        std::vector<std::array<const place_form*, 2>> terms;
        for (std::size_t k = 0; k < columns.size(); ++k)
            if (fit.weights[k] > 1e-9) terms.push_back(factors[k]);
        if (known_->contains(terms)) return true;
        std::vector<std::vector<big_integer>> exact;
        for (const auto& [f, g] : terms) exact.push_back(g ? side_view::product(*f, *g) : f->exact);
        if (!vanishes(std::move(exact))) return false;
        known_->insert(std::move(terms));
        return true;
    }

private:
    static double times(const std::vector<double>& a, const std::vector<double>& b)
    {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    }

    static std::vector<double> rounded_product(const place_form& f, const place_form& g)
    {
        std::vector<double> result;
        for (std::size_t i = 0; i < side_view::unknowns; ++i)
            for (std::size_t j = i; j < side_view::unknowns; ++j)
                result.push_back(i == j ? f.rounded[i] * g.rounded[i]
                                        : f.rounded[i] * g.rounded[j] + f.rounded[j] * g.rounded[i]);
        const double length = std::sqrt(times(result, result));
        for (double& x : result) x /= length;
        return result;
    }

    relations* known_;
    std::vector<const place_form*> linear_, bilinear_;
    std::vector<std::vector<double>> witnesses_;
};

/// Search for a contradiction around one edge, as seen from one side.
class crowded_edge
{
public:
    using tetra = side_view::tetra;

    /// The edge from first to second, both free. around: the cells of each vertex.
    crowded_edge(const untangle_problem<tetrahedron>& p, const csr& around, const flat_side& side, idx first,
                 idx second)
        : first_(first), second_(second)
    {
        const auto at = [](idx i) { return static_cast<std::size_t>(i); };
        // Free vertices beside the edge, and the tetrahedra between them and the side.
        std::vector<idx> free{first, second};
        for (const idx c : around.row(first))
        {
            const auto& t = p.rest.cells()[at(c)];
            if (std::find(t.begin(), t.end(), second) == t.end()) continue;
            for (const idx v : t)
                if (!p.held.any(at(v)) && std::find(free.begin(), free.end(), v) == free.end()) free.push_back(v);
        }
        const auto inside = [&](idx v) { return std::find(free.begin(), free.end(), v) != free.end(); };
        const auto on_side = [&](idx v) { return p.held.all(at(v)) && p.initial[at(v)][side.axis] == side.at; };
        for (const idx v : free)
            for (const idx c : around.row(v))
            {
                const auto& t = p.rest.cells()[at(c)];
                if (std::all_of(t.begin(), t.end(), [&](idx w) { return inside(w) || on_side(w); }))
                    cells_.push_back(c);
            }
        std::sort(cells_.begin(), cells_.end());
        cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
        for (const idx c : cells_)
            for (const idx v : p.rest.cells()[at(c)])
                if (on_side(v)) corners_.push_back(v);
        std::sort(corners_.begin(), corners_.end());
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
        if (corners_.size() < 3) return;
        view_.emplace(p, side, first, second, corners_);
        thirds_.assign(free.begin() + 2, free.end());
        for (const idx c : cells_) facts_.push_back(p.rest.cells()[at(c)]);
        for (const idx u : free)
            for (const idx w : free)
                if (u != w) divide(p, around, u, w);
    }

    /// Returns whether there is a proof, of at most so many cases, before proceed() returns false.
    bool prove(int cases, std::function<bool()> proceed)
    {
        cases_ = cases;
        proceed_ = std::move(proceed);
        if (!view_) return false;
        std::vector<const choice*> open;
        for (const auto& c : choices_) open.push_back(&c);
        return refute(facts_, std::move(open));
    }

    const std::vector<idx>& cells() const { return cells_; } ///< that the proof is about

private:
    using choice = std::vector<std::vector<tetra>>; ///< sets, of one of which all are positive

    /// If u - w is an edge of four tetrahedra: the cases of the other corners around it, where all of their tetrahedra
    /// are of use.
    void divide(const untangle_problem<tetrahedron>& p, const csr& around, idx u, idx w)
    {
        std::map<idx, idx> next;
        for (const idx c : around.row(u))
        {
            const auto& t = p.rest.cells()[static_cast<std::size_t>(c)];
            const auto iu = std::find(t.begin(), t.end(), u) - t.begin(),
                       iw = std::find(t.begin(), t.end(), w) - t.begin();
            if (iw == 4) continue;
            std::array<std::size_t, 2> others{};
            std::size_t count = 0;
            for (std::ptrdiff_t k = 0; k < 4; ++k)
                if (k != iu && k != iw) others[count++] = static_cast<std::size_t>(k);
            // (u, w, a, b) is an even permutation of the cell's corners, or b and a change places.
            const bool odd = ((iu + iw + (iu > iw ? 1 : 0)) % 2 == 0);
            if (odd) std::swap(others[0], others[1]);
            next[t[others[0]]] = t[others[1]];
        }
        if (next.size() != 4) return;
        std::array<idx, 4> q{next.begin()->first};
        for (std::size_t k = 1; k < 4; ++k)
        {
            const auto after = next.find(q[k - 1]);
            if (after == next.end()) return;
            q[k] = after->second;
        }
        auto cases = cases_around(u, q);
        for (const auto& set : cases)
            for (const auto& t : set)
                if (!view_->third(t) || view_->form(t).degree == 0) return;
        choices_.push_back(std::move(cases));
    }

    /// True if the facts, tetrahedra that are positive, contradict each other whatever is chosen. The choice that
    /// leaves least comes first.
    bool refute(std::vector<tetra> facts, std::vector<const choice*> open)
    {
        if (cases_-- <= 0 || !proceed_()) return false;
        if (contradict(facts)) return true;
        std::vector<std::vector<tetra>> least;
        std::size_t chosen = open.size();
        for (std::size_t k = 0; k < open.size(); ++k)
        {
            std::vector<std::vector<tetra>> left;
            for (const auto& set : *open[k])
            {
                auto more = facts;
                more.insert(more.end(), set.begin(), set.end());
                auto systems = systems_of(more);
                if (!any_contradictory(systems)) left.push_back(std::move(more));
            }
            if (chosen < open.size() && left.size() >= least.size()) continue;
            chosen = k;
            least = std::move(left);
            if (least.size() <= 1) break;
        }
        if (chosen == open.size()) return false;
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(chosen));
        return std::all_of(least.begin(), least.end(), [&](auto& more) { return refute(std::move(more), open); });
    }

    static bool any_contradictory(std::vector<place_system>& systems)
    {
        return std::any_of(systems.begin(), systems.end(), [](auto& s) { return s.contradictory(); });
    }

    /// The same without choices: what one third vertex says of the edge's direction goes on to the others.
    bool contradict(std::vector<tetra>& facts)
    {
        auto systems = systems_of(facts);
        if (any_contradictory(systems)) return true;
        for (bool news = true; news;)
        {
            news = false;
            for (std::size_t i = 0; i < corners_.size(); ++i)
                for (std::size_t j = 0; j < i; ++j)
                {
                    const tetra t{corners_[i], corners_[j], first_, second_};
                    const auto &positive = view_->form(t), &negative = view_->form(mirrored(t));
                    for (auto& s : systems)
                    {
                        if (s.follows(positive) || s.follows(negative)) continue;
                        const bool must = s.contradictory(&negative);
                        if (!must && !s.contradictory(&positive)) continue;
                        facts.push_back(must ? t : mirrored(t));
                        systems = systems_of(facts);
                        if (any_contradictory(systems)) return true;
                        news = true;
                        break;
                    }
                }
        }
        return false;
    }

    /// One system for each third vertex, with the facts about it and the edge; of the edge alone if there is none.
    std::vector<place_system> systems_of(const std::vector<tetra>& facts)
    {
        std::vector<place_system> systems(std::max<std::size_t>(thirds_.size(), 1), place_system(known_));
        for (const auto& t : facts)
            if (const auto v = view_->third(t))
                for (std::size_t k = 0; k < systems.size(); ++k)
                    if (*v < 0 || *v == thirds_[k]) systems[k].add(view_->form(t));
        for (auto& s : systems) s.thin();
        return systems;
    }

    idx first_, second_;
    std::optional<side_view> view_;
    std::vector<idx> cells_, corners_, thirds_;
    std::vector<tetra> facts_;
    std::vector<choice> choices_;
    place_system::relations known_;
    int cases_ = 0; // left
    std::function<bool()> proceed_;
};

/// Finds the flat sides of a mesh whose outline is pinned as a whole. Inner vertices of a map of positive elements lie
/// within: points beyond, which the outline does not wind about, are not covered, and all around an inner vertex are.
inline std::vector<flat_side> flat_sides(const untangle_problem<tetrahedron>& p)
{
    std::vector<flat_side> sides;
    if (!p.owners.empty() || !p.sliding.empty() || !p.outline_pinned()) return sides;
    const auto outline = boundary_facets(p.rest, p.owners);
    if (outline.empty()) return sides;
    for (int axis = 0; axis < 3; ++axis)
    {
        double low = p.initial[static_cast<std::size_t>(outline[0][0])][axis], high = low;
        for (const auto& facet : outline)
            for (const idx v : facet)
            {
                low = std::min(low, p.initial[static_cast<std::size_t>(v)][axis]);
                high = std::max(high, p.initial[static_cast<std::size_t>(v)][axis]);
            }
        sides.push_back({axis, low, 1});
        sides.push_back({axis, high, -1});
    }
    return sides;
}

/// Searches for an edge of these tetrahedra, both of its ends free, that has no direction in which its tetrahedra, seen
/// from a flat side of the outline, can be positive.
inline void judge_edges(const untangle_problem<tetrahedron>& p, std::span<const idx> cells,
                        const std::function<bool()>& proceed, infeasibility& found)
{
    constexpr int cases = 500;
    const auto sides = flat_sides(p);
    if (sides.empty()) return;
    const csr around = vertex_cells(p.rest);
    std::vector<std::array<idx, 2>> edges;
    for (const idx c : cells)
        for (const idx a : p.rest.cells()[static_cast<std::size_t>(c)])
            for (const idx b : p.rest.cells()[static_cast<std::size_t>(c)])
                if (a < b && !p.held.any(static_cast<std::size_t>(a)) && !p.held.any(static_cast<std::size_t>(b)))
                    edges.push_back({a, b});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const auto& [a, b] : edges)
        for (const auto& side : sides)
        {
            crowded_edge edge(p, around, side, a, b);
            if (!edge.prove(cases, proceed)) continue;
            std::vector<idx> ids{a, b};
            ids.insert(ids.end(), edge.cells().begin(), edge.cells().end());
            found.prove(infeasibility_kind::crowded_edge, std::move(ids),
                        [](const auto& all)
                        {
                            return "the edge between vertices " + std::to_string(all[0]) + " and " +
                                   std::to_string(all[1]) + " has no direction in which the " +
                                   std::to_string(all.size() - 2) +
                                   " tetrahedra between what lies around it and a flat side can all be positive; split "
                                   "the edge or move pinned vertices of that side";
                        });
            return;
        }
}

} // namespace taut::impl
