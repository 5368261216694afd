// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/errors.hpp>
#include <taut/impl/dist/processes/part.hpp>
#include <taut/types.hpp>

namespace taut::dist::impl
{

/// Spring of an owned vertex.
template <int D>
struct owned_spring
{
    std::size_t vertex;
    vec<D> target;
    double weight;
};

/// Constraints of the vertices of a part, halo included, in lengths of the caller.
template <class Element>
class fixed_part
{
public:
    static constexpr int D = Element::dimension;
    using point = vec<D>;

    std::vector<std::uint8_t> marks;      ///< fixed coordinates: bit k for coordinate k
    std::vector<double> targets;          ///< D a vertex, of fixed coordinates
    std::vector<owned_spring<D>> springs; ///< of owned vertices
    std::vector<mat<D>> slides;           ///< projection of displacements, one a vertex; empty: none slides

    /// None; vertices without cells are fixed where they are.
    explicit fixed_part(const part<Element>& p)
        : marks(p.size(), 0), targets(static_cast<std::size_t>(D) * p.size(), 0.0), idle_(p.size(), 1)
    {
        for (const auto& c : p.corners)
            for (const idx v : c) idle_[static_cast<std::size_t>(v)] = 0;
    }

    /// Collective. Replaces all. Throws constraint_error, with nothing changed.
    void take(const part<Element>& p, const constraints<Element>& given)
    {
        using entry = typename constraints<Element>::entry;
        p.all.together([&] { require(given); });
        std::vector<std::int64_t> ids;
        for (const entry& e : given.entries()) ids.push_back(e.id);
        const auto numbers = p.find(ids);
        parcels<entry> to(p.all.ranks());
        p.all.together(
            [&]
            {
                for (std::size_t i = 0; i < ids.size(); ++i)
                {
                    if (numbers[i] < 0)
                        refuse(constraint_error::out_of_range, ids[i], "that the mesh does not have; count from 0");
                    const auto place = p.place_of(numbers[i]);
                    auto e = given.entries()[i];
                    e.id = place.place;
                    to[place.rank].push_back(e);
                }
            });
        const auto mine = p.all.exchange(to).items;
        fixed_part next(*this);
        p.all.together([&] { next.set(p, mine); });
        p.update(next.marks);
        p.update(next.targets, D);
        next.slides = slides;
        *this = std::move(next);
    }

    bool held(std::size_t v, int k) const { return (marks[v] >> k & 1U) != 0; }
    bool pinned(std::size_t v) const { return marks[v] == every; }
    /// Whether a vertex has no coordinate that may change.
    bool still(std::size_t v) const { return idle_[v] != 0 || pinned(v); }

    /// The projection of displacements of a vertex on the admissible ones.
    mat<D> projection(std::size_t v) const
    {
        if (idle_[v] != 0) return mat<D>(0.0);
        mat<D> P = slides.empty() ? mat<D>(1.0) : slides[v];
        for (int k = 0; k < D; ++k)
            if (held(v, k))
                for (int j = 0; j < D; ++j) P[k][j] = P[j][k] = 0;
        return P;
    }
    /// Whether projection() leaves something out.
    bool restrained(std::size_t v) const { return idle_[v] != 0 || marks[v] != 0 || !slides.empty(); }

    /// Projects the displacements of owned vertices.
    void project(const part<Element>& p, std::vector<double>& d) const
    {
        for (std::size_t v = 0; v < p.own; ++v)
        {
            if (!restrained(v)) continue;
            point x;
            for (int k = 0; k < D; ++k) x[k] = d[D * v + static_cast<std::size_t>(k)];
            x = projection(v) * x;
            for (int k = 0; k < D; ++k) d[D * v + static_cast<std::size_t>(k)] = x[k];
        }
    }

private:
    static constexpr std::uint8_t every = taut::impl::fixed_marks<D>::every;

    [[noreturn]] static void refuse(constraint_error::fault_type fault, std::int64_t id, const std::string& why)
    {
        throw constraint_error(fault, {}, "1 vertex (" + std::to_string(id) + ") " + why);
    }

    static void require(const constraints<Element>& given)
    {
        for (const auto& e : given.entries())
        {
            if (e.held == 0 && e.weight == 0)
                refuse(constraint_error::no_coordinate, e.id,
                       "with a pin of a coordinate that it does not have, or a spring of weight 0; coordinates count "
                       "from 0");
            if (!(e.weight >= 0) || !std::isfinite(e.weight))
                refuse(constraint_error::bad_weight, e.id,
                       "with a spring whose weight is negative or not finite; give a finite one > 0");
            for (int k = 0; k < D; ++k)
                if (!std::isfinite(e.x[k]))
                    refuse(constraint_error::not_finite, e.id, "with a target that is not finite; give a finite one");
        }
    }

    void set(const part<Element>& p, const std::vector<typename constraints<Element>::entry>& mine)
    {
        std::fill(marks.begin(), marks.end(), std::uint8_t{0});
        springs.clear();
        std::vector<char> sprung(p.own, 0);
        for (const auto& e : mine)
        {
            const auto v = static_cast<std::size_t>(e.id);
            if (idle_[v] != 0)
                refuse(constraint_error::unused_vertex, p.ids[v],
                       std::string("pinned that no ") + Element::name +
                           " uses, so that nothing follows; leave its pin out");
            if (e.held == 0)
            {
                if (sprung[v]++ != 0)
                    refuse(constraint_error::duplicate, p.ids[v], "with a second spring; leave one out");
                springs.push_back({v, e.x, e.weight});
                continue;
            }
            for (int k = 0; k < D; ++k)
            {
                if ((e.held >> k & 1U) == 0) continue;
                double& target = targets[D * v + static_cast<std::size_t>(k)];
                if (held(v, k) && target != e.x[k])
                    refuse(constraint_error::contradictory, p.ids[v],
                           "pinned to two different positions; leave one of them out");
                target = e.x[k];
                marks[v] = static_cast<std::uint8_t>(marks[v] | 1U << k);
            }
        }
        for (const auto& s : springs)
            if (pinned(s.vertex))
                refuse(constraint_error::idle_spring, p.ids[s.vertex],
                       "with a spring and a pin, which leaves the spring nothing to do; leave one of them out");
    }

    std::vector<char> idle_;
};

} // namespace taut::dist::impl
