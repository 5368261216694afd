// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Parameters of settling a map of the plane.
struct settling
{
    vec2 (*stored)(vec2) = nullptr;                         ///< rounding of coordinates by the file format; null: none
    double reach = std::numeric_limits<double>::infinity(); ///< farthest that a vertex may be from where it was
    std::span<const char> held = {};                        ///< vertices that stay where they are; or empty
    bool apart = true;                                      ///< borders that meet already are to be parted
};

/// Faults of a map.
struct map_faults
{
    std::size_t flipped = 0;  ///< triangles that are not positive
    std::size_t meetings = 0; ///< pairs of border edges that have a common point beyond a common vertex
    std::size_t concave = 0;  ///< corners that are to be convex and are not

    bool valid() const { return flipped + meetings == 0; }
    explicit operator bool() const { return valid() && concave == 0; }
};

/// Approximate spacing of a file's numbers near a point.
inline double spacing_at(const vec2& p, vec2 (*stored)(vec2))
{
    const double size = std::max({std::abs(p.x), std::abs(p.y), std::numeric_limits<double>::min()});
    const double least = std::exp2(std::floor(std::log2(size)) - 52);
    if (stored == nullptr) return least;
    const vec2 x = stored(p);
    double spacing = 0;
    for (int c = 0; c < 2; ++c)
    {
        double change = 0;
        for (double step = least; change == 0 && step < 2 * size; step *= 2)
            change = std::abs(stored(x + step)[c] - x[c]);
        spacing = std::max(spacing, change);
    }
    return std::max(spacing, least);
}

/// One run of settle_piece().
class map_settling
{
public:
    /// origin: where vertices of the piece are before
    map_settling(std::span<const std::array<idx, 3>> cells, std::span<const std::array<idx, 3>> corners, idx first,
                 std::span<const vec2> origin, std::span<vec2> x, const settling& how)
        : cells_(cells), corners_(corners), first_(first), origin_(origin), x_(x), how_(how)
    {
        vec2 far(0.0);
        for (const vec2& p : origin_) far = glm::max(far, glm::abs(p));
        step_ = spacing_at(far, how_.stored);
        cells_at_ = around(cells_);
        corners_at_ = around(corners_);
        find_border();
    }

    /// Returns what is left.
    map_faults run()
    {
        constexpr int most_rounds = 64;
        spread();
        for (std::size_t v = 0; v < origin_.size(); ++v)
            if (vec2& p = x_[v + u(first_)]; how_.stored != nullptr && !is_held(static_cast<idx>(v) + first_))
                p = how_.stored(p);
        map_faults faults = look();
        for (int round = 0; round < most_rounds && !faults.valid(); ++round)
        {
            bool any = false;
            for (const idx v : bad_) any = mend(v) || any;
            if (!any) break;
            faults = look();
        }
        for (int round = 0; round < most_rounds && faults.valid() && faults.concave > 0; ++round)
        {
            bool any = false;
            for (std::size_t k = 0; k < corners_.size(); ++k)
                if (turn(corners_[k]) <= 0) any = make_convex(corners_[k]) || any;
            if (!any) break;
            const std::size_t before = faults.concave;
            faults = look();
            if (faults.concave >= before) break; // corners take turns: the polygon is too small for the digits
        }
        return faults;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    std::size_t local(idx v) const { return u(v - first_); }

    csr around(std::span<const std::array<idx, 3>> triples) const
    {
        csr at;
        at.offsets.assign(origin_.size() + 2, 0);
        for (const auto& t : triples)
            for (const idx v : t) ++at.offsets[local(v) + 2];
        for (std::size_t v = 2; v < at.offsets.size(); ++v) at.offsets[v] += at.offsets[v - 1];
        at.items.resize(3 * triples.size());
        for (std::size_t k = 0; k < triples.size(); ++k)
            for (const idx v : triples[k]) at.items[u(at.offsets[local(v) + 1]++)] = static_cast<idx>(k);
        at.offsets.pop_back();
        return at;
    }

    /// The sides that one triangle has.
    void find_border()
    {
        for (const auto& t : cells_)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx a = t[k], b = t[(k + 1) % 3];
                const auto cells = cells_at_.row(b - first_);
                const bool inner = std::any_of(cells.begin(), cells.end(),
                                               [&](idx c)
                                               {
                                                   const auto& s = cells_[u(c)];
                                                   for (std::size_t j = 0; j < 3; ++j)
                                                       if (s[j] == b && s[(j + 1) % 3] == a) return true;
                                                   return false;
                                               });
                if (!inner) border_.push_back({a, b});
            }
        border_at_.offsets.assign(origin_.size() + 2, 0);
        for (const auto& e : border_)
            for (const idx v : e) ++border_at_.offsets[local(v) + 2];
        for (std::size_t v = 2; v < border_at_.offsets.size(); ++v) border_at_.offsets[v] += border_at_.offsets[v - 1];
        border_at_.items.resize(2 * border_.size());
        for (std::size_t e = 0; e < border_.size(); ++e)
            for (const idx v : border_[e])
                border_at_.items[u(border_at_.offsets[local(v) + 1]++)] = static_cast<idx>(e);
        border_at_.offsets.pop_back();
    }

    int turn(const std::array<idx, 3>& t) const { return orient2d(x_[u(t[0])], x_[u(t[1])], x_[u(t[2])]); }

    /// Widens triangles that are thinner than two units and may be flattened by rounding: a stack of needles gets room
    /// from one end to the other.
    void spread()
    {
        constexpr int most_sweeps = 256;
        const double least = 2 * step_, most = 0.9 * how_.reach - step_;
        std::vector<idx> thin;
        for (std::size_t c = 0; c < cells_.size(); ++c)
            if (height(cells_[c]) < least + std::min(64 * step_, 2 * how_.reach)) thin.push_back(static_cast<idx>(c));
        bool any = true;
        for (int sweep = 0; sweep < most_sweeps && any; ++sweep)
        {
            any = false;
            for (const idx c : thin)
            {
                auto [p, q, r] = cells_[u(c)];
                std::tie(p, q, r) = across_longest(p, q, r);
                const vec2 side = x_[u(r)] - x_[u(q)];
                const double length = glm::length(side);
                if (!(length > 0)) continue;
                const vec2 inward = vec2(-side.y, side.x) / length;
                const double missing = least - glm::dot(x_[u(p)] - x_[u(q)], inward);
                if (!(missing > 1e-3 * least)) continue;
                const double share = std::clamp(glm::dot(x_[u(p)] - x_[u(q)], side) / (length * length), 0.0, 1.0);
                push(p, 0.5 * missing * inward, most);
                push(q, -0.5 * missing * (1 - share) * inward, most);
                push(r, -0.5 * missing * share * inward, most);
                any = true;
            }
        }
    }

    /// The corners of a triangle, beginning with the one across the longest side.
    std::tuple<idx, idx, idx> across_longest(idx p, idx q, idx r) const
    {
        const auto squared = [this](idx a, idx b)
        {
            const vec2 d = x_[u(b)] - x_[u(a)];
            return glm::dot(d, d);
        };
        const double qr = squared(q, r), rp = squared(r, p), pq = squared(p, q);
        if (qr >= rp && qr >= pq) return {p, q, r};
        return rp >= pq ? std::tuple(q, r, p) : std::tuple(r, p, q);
    }

    double height(const std::array<idx, 3>& t) const
    {
        const auto [p, q, r] = across_longest(t[0], t[1], t[2]);
        const double length = glm::length(x_[u(r)] - x_[u(q)]);
        return length > 0 ? orient(x_[u(p)], x_[u(q)], x_[u(r)]).det / length : 0;
    }

    /// Moves a vertex, within a maximum distance from its origin.
    void push(idx v, const vec2& by, double most)
    {
        if (is_held(v)) return;
        const vec2 way = x_[u(v)] + by - origin_[local(v)];
        const double length = glm::length(way);
        x_[u(v)] = origin_[local(v)] + (length > most ? most / length : 1.0) * way;
    }

    /// Counts the faults, and finds their vertices.
    map_faults look()
    {
        map_faults faults;
        bad_.clear();
        if (state_ == neighbours::many) state_ = neighbours::unknown;
        for (const auto& t : cells_)
            if (turn(t) <= 0)
            {
                ++faults.flipped;
                bad_.insert(bad_.end(), t.begin(), t.end());
            }
        const auto meet = [&](std::size_t i, std::size_t j)
        {
            ++faults.meetings;
            bad_.insert(bad_.end(), border_[i].begin(), border_[i].end());
            bad_.insert(bad_.end(), border_[j].begin(), border_[j].end());
            return true;
        };
        if (how_.apart) for_each_meeting(border_, x_, meet, 64 * border_.size() + 4096);
        for (const auto& t : corners_) faults.concave += turn(t) <= 0 ? 1 : 0;
        std::sort(bad_.begin(), bad_.end());
        bad_.erase(std::unique(bad_.begin(), bad_.end()), bad_.end());
        return faults;
    }

    /// Pairs of a border edge at v and another one that meet.
    std::size_t meetings_at(idx v)
    {
        if (state_ == neighbours::unknown) find_neighbours();
        const bool known = state_ == neighbours::listed && within_margin(v);
        std::size_t count = 0;
        for (const idx e : border_at_.row(v - first_))
        {
            const edge_box box = edge_box::of(border_[u(e)], x_);
            const auto look = [&](idx f)
            {
                if (f != e && box.meets(edge_box::of(border_[u(f)], x_)) &&
                    edges_meet(border_[u(e)], border_[u(f)], x_))
                    ++count;
            };
            if (known && !is_far_[u(e)])
            {
                for (const idx f : near_.row(e))
                    if (!is_far_[u(f)]) look(f);
                for (const idx f : far_) look(f);
            }
            else
                for (idx f = 0; f < static_cast<idx>(border_.size()); ++f) look(f);
        }
        return count;
    }

    /// Finds the edges that may meet each border edge while no vertex moves farther than a margin along an axis.
    void find_neighbours()
    {
        double length = 0;
        for (const auto& [a, b] : border_) length += glm::length(x_[u(b)] - x_[u(a)]);
        margin_ = 4 * step_ + 0.25 * length / static_cast<double>(std::max<std::size_t>(1, border_.size()));
        reference_.assign(x_.begin() + first_, x_.begin() + first_ + static_cast<std::ptrdiff_t>(origin_.size()));
        is_far_.assign(border_.size(), 0);
        far_.clear();
        state_ = neighbours::many; // unless it turns out otherwise
        const std::size_t most = 64 * border_.size() + 4096;
        const double reach = 3 * margin_; // 2 sqrt 2 from two corners
        std::vector<std::array<idx, 2>> pairs;
        const auto finite_ends = [this](const auto& e) { return finite(x_[u(e[0])]) && finite(x_[u(e[1])]); };
        if (!std::all_of(border_.begin(), border_.end(), finite_ends)) return;
        edge_tree(border_, x_)
            .for_each_pair_within(reach,
                                  [&](std::size_t i, std::size_t j)
                                  {
                                      pairs.push_back({static_cast<idx>(i), static_cast<idx>(j)});
                                      return pairs.size() < most;
                                  });
        if (pairs.size() >= most) return;
        near_.offsets.assign(border_.size() + 2, 0);
        for (const auto& pair : pairs)
            for (const idx e : pair) ++near_.offsets[u(e) + 2];
        for (std::size_t e = 2; e < near_.offsets.size(); ++e) near_.offsets[e] += near_.offsets[e - 1];
        near_.items.resize(2 * pairs.size());
        for (const auto& [i, j] : pairs)
        {
            near_.items[u(near_.offsets[u(i) + 1]++)] = j;
            near_.items[u(near_.offsets[u(j) + 1]++)] = i;
        }
        near_.offsets.pop_back();
        state_ = neighbours::listed;
    }

    bool within_margin(idx v) const
    {
        const vec2 d = glm::abs(x_[u(v)] - reference_[local(v)]);
        return d.x <= margin_ && d.y <= margin_;
    }

    /// Edges of a vertex that stays beyond the margin are looked at by all; where there are many, all begins anew.
    void note_move(idx v)
    {
        if (state_ != neighbours::listed || within_margin(v)) return;
        for (const idx e : border_at_.row(v - first_))
            if (!std::exchange(is_far_[u(e)], char(1))) far_.push_back(e);
        if (far_.size() > 32) state_ = neighbours::unknown;
    }

    /// Penalty of the triangles at v: how far they are from the other side, in steps, and how many; and edges that are
    /// shorter than a step, which make triangles flat.
    double flips_at(idx v) const
    {
        double sum = 0;
        for (const idx c : cells_at_.row(v - first_))
        {
            const auto& t = cells_[u(c)];
            const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
            const vec2 &p = x_[u(v)], &q = x_[u(t[(k + 1) % 3])], &r = x_[u(t[(k + 2) % 3])];
            if (const auto o = orient(p, q, r); o.sign <= 0)
                sum += 1 - o.det / (step_ * std::max(step_, glm::length(r - q)));
            sum += 0.125 * std::max(0.0, 1 - glm::length(q - p) / step_);
            sum += 0.125 * std::max(0.0, 1 - glm::length(r - p) / step_);
        }
        return sum;
    }

    std::size_t concave_at(idx v) const
    {
        std::size_t count = 0;
        for (const idx k : corners_at_.row(v - first_)) count += turn(corners_[u(k)]) <= 0 ? 1 : 0;
        return count;
    }

    bool is_held(idx v) const { return !how_.held.empty() && how_.held[u(v)] != 0; }

    /// Moves a vertex to a rounded position, if it is within reach.
    bool place(idx v, const vec2& at)
    {
        const vec2 p = how_.stored == nullptr ? at : how_.stored(at);
        if (p == x_[u(v)] || !finite(p) || !(glm::length(p - origin_[local(v)]) <= how_.reach)) return false;
        x_[u(v)] = p;
        return true;
    }

    /// Moves a vertex to the nearest position, in eight directions, with fewer faults.
    bool mend(idx v)
    {
        if (is_held(v)) return false;
        const vec2 before = x_[u(v)];
        const double meetings = static_cast<double>(meetings_at(v));
        const double least = flips_at(v) + meetings;
        if (least == 0) return false;
        vec2 best = before;
        double fewest = least;
        const double most = std::min(how_.reach, std::exp2(40) * step_);
        for (double radius = step_; radius <= 2 * most && fewest == least; radius *= 2)
            for (int x = -2; x <= 2; ++x)
                for (int y = -2; y <= 2; ++y)
                {
                    if (std::max(std::abs(x), std::abs(y)) < (radius == step_ ? 1 : 2)) continue;
                    if (!place(v, before + radius * 0.5 * vec2(x, y))) continue;
                    double wrong = flips_at(v);
                    if (wrong < fewest) wrong += static_cast<double>(meetings_at(v));
                    if (wrong < fewest)
                    {
                        fewest = wrong;
                        best = x_[u(v)];
                    }
                    x_[u(v)] = before;
                }
        x_[u(v)] = best;
        note_move(v);
        return fewest < least;
    }

    /// Moves one of the vertices of a corner so that it turns left, without flipped triangles or crossings, and with
    /// fewer faults.
    bool make_convex(const std::array<idx, 3>& corner)
    {
        for (const std::size_t k : {1U, 0U, 2U})
        {
            const idx v = corner[k];
            if (is_held(v)) continue;
            const vec2 before = x_[u(v)];
            const vec2 &q = x_[u(corner[(k + 1) % 3])], &r = x_[u(corner[(k + 2) % 3])];
            const vec2 side = r - q;
            const double length = glm::length(side);
            if (!(length > 0)) continue;
            const vec2 inward = vec2(-side.y, side.x) / length; // to where the corner is convex
            const double missing = std::max(0.0, -orient(q, r, before).det / length);
            const std::size_t wrong = concave_at(v), meetings = meetings_at(v);
            for (int e = 10; e >= 1; --e)
            {
                const double beyond = std::max(2 * step_, std::exp2(-e) * std::min(length, glm::length(before - q)));
                if (!place(v, before + (missing + beyond) * inward)) continue;
                const auto cells = cells_at_.row(v - first_);
                const bool upright =
                    std::all_of(cells.begin(), cells.end(), [&](idx c) { return turn(cells_[u(c)]) > 0; });
                if (upright && turn(corner) > 0 && concave_at(v) < wrong && meetings_at(v) <= meetings)
                {
                    note_move(v);
                    return true;
                }
                x_[u(v)] = before;
            }
        }
        return false;
    }

    std::span<const std::array<idx, 3>> cells_, corners_;
    idx first_;
    std::span<const vec2> origin_;
    std::span<vec2> x_;
    const settling& how_;
    double step_;
    csr cells_at_, corners_at_, border_at_; // at each vertex of the piece
    std::vector<std::array<idx, 2>> border_;
    std::vector<idx> bad_;

    enum class neighbours
    {
        unknown,
        listed,
        many ///< until the next round all edges are looked at
    };
    neighbours state_ = neighbours::unknown;
    csr near_;             // of border edges
    std::vector<idx> far_; // border edges of vertices that have left the margin
    std::vector<char> is_far_;
    double margin_ = 0;
    std::vector<vec2> reference_; // where near_ was found
};

/// Corrects a map of one piece, as a chart, by minimal motions of vertices: triangles flipped by rounding, borders that
/// meet, and concave corners of polygons that should be convex; vertex by vertex, in exact arithmetic. Valid parts
/// remain valid.
/// cells:   of the piece, whose vertices are numbered from `first`
/// corners: triples of them that are to turn left, as those of convex_polygons
/// x: of the whole map: positions, then the rounded ones
/// Returns the remaining faults.
inline map_faults settle_piece(std::span<const std::array<idx, 3>> cells, std::span<const std::array<idx, 3>> corners,
                               idx first, idx end, std::span<vec2> x, const settling& how = {})
{
    const auto own = x.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
    const std::vector<vec2> origin(own.begin(), own.end());
    return impl::map_settling(cells, corners, first, origin, x, how).run();
}

} // namespace taut::impl
