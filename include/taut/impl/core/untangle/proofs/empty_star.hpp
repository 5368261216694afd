// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/impl/core/untangle/proofs/vanishing_sum.hpp>
#include <taut/untangle_problem.hpp>

/// Proof test: whether a free vertex has a position where all its elements whose other corners are pinned are positive.
namespace taut::impl
{

/// The positions of one vertex that make its elements positive: of each element with pinned other corners an open
/// half-space, (n, c) . (x, 1) > 0.
template <class Element>
class star_conditions
{
public:
    static constexpr int D = Element::dimension;

    /// Refers to the problem. corners: of the vertex, as vertex_corners() has them.
    star_conditions(const untangle_problem<Element>& p, idx vertex, std::span<const idx> corners)
        : problem_(p), vertex_(static_cast<std::size_t>(vertex))
    {
        for (const idx corner : corners)
        {
            const auto& cell = p.rest.cells()[static_cast<std::size_t>(corner / Element::corners)];
            if (std::all_of(cell.begin(), cell.end(), [&](idx v) { return v == vertex || pinned(v); }))
                corners_.push_back(corner);
        }
    }

    /// True if its position in the problem is one of them.
    bool met() const
    {
        return std::all_of(corners_.begin(), corners_.end(), [this](idx corner) { return sign_of(corner) > 0; });
    }

    /// Cells, at most D + 1, whose half-spaces have no point in common, or none. The result is exact. By Farkas' lemma
    /// there is a vanishing sum of conditions, and of 1 > 0, with weights that are not negative; by Helly's theorem
    /// D + 1 half-spaces suffice. Floating point says which.
    std::vector<idx> contradiction() const
    {
        constexpr std::size_t most = 2000, suffice = D + 1; // of conditions: what costs more is not worth finding
        if (corners_.size() < 2 || corners_.size() > most) return {};
        const auto fit = fit_nonnegative(rounded(), target());
        if (fit.error() > 1e-6) return {};
        std::vector<idx> chosen;
        for (std::size_t k = 0; k < corners_.size(); ++k)
            if (fit.weights[k] > 1e-9) chosen.push_back(corners_[k]);
        if (chosen.size() <= suffice) return contradict(chosen) ? cells_of(chosen) : std::vector<idx>();
        for (std::size_t k = 0; k < chosen.size() && chosen.size() == suffice + 1; ++k)
        {
            auto fewer = chosen;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
            if (contradict(fewer)) return cells_of(fewer);
        }
        return {};
    }

private:
    using column = std::vector<double>;

    bool pinned(idx v) const { return problem_.held.all(static_cast<std::size_t>(v)); }
    bool is_free(int k) const { return !problem_.held.test(vertex_, k); }
    const vec<D>& place(idx v) const { return problem_.initial[static_cast<std::size_t>(v)]; }

    /// The pinned corners of an element, ordered so that (..., vertex) is positive where the element is.
    std::array<idx, D> others(idx corner) const
    {
        const auto& cell = problem_.rest.cells()[static_cast<std::size_t>(corner / Element::corners)];
        const int own = corner % Element::corners;
        std::array<idx, D> v{};
        for (int k = 0, i = 0; k < Element::corners; ++k)
            if (k != own) v[static_cast<std::size_t>(i++)] = cell[static_cast<std::size_t>(k)];
        if ((D - own) % 2 != 0) std::swap(v[0], v[1]);
        return v;
    }

    int sign_of(idx corner) const
    {
        const auto v = others(corner);
        if constexpr (D == 2)
            return orient2d(place(v[0]), place(v[1]), place(static_cast<idx>(vertex_)));
        else
            return orient3d(place(v[0]), place(v[1]), place(v[2]), place(static_cast<idx>(vertex_)));
    }

    /// Normal and constant of a condition, of coordinates relative to a corner, in any arithmetic; of what is fixed of
    /// the vertex the constant takes the part. difference(a, b, k): coordinate k of a - b.
    template <class Number, class Difference>
    std::vector<Number> form(idx corner, const Difference& difference) const
    {
        const auto v = others(corner);
        const idx origin = others(corners_.front())[0];
        const auto edge = [&](std::size_t i, int k) { return difference(place(v[i]), place(v[0]), k); };
        std::vector<Number> n, result;
        if constexpr (D == 2)
            n = {-edge(1, 1), edge(1, 0)};
        else
            for (int k = 0; k < 3; ++k)
            {
                const int a = (k + 1) % 3, b = (k + 2) % 3;
                n.push_back(edge(1, a) * edge(2, b) - edge(1, b) * edge(2, a));
            }
        Number constant{};
        for (int k = 0; k < D; ++k)
        {
            const auto& normal = n[static_cast<std::size_t>(k)];
            constant = constant - normal * difference(place(v[0]), place(origin), k);
            if (is_free(k))
                result.push_back(normal);
            else
                constant = constant + normal * difference(place(static_cast<idx>(vertex_)), place(origin), k);
        }
        result.push_back(constant);
        return result;
    }

    /// Exact.
    bool contradict(std::span<const idx> corners) const
    {
        std::vector<std::vector<big_integer>> columns;
        const int power = least_power();
        for (const idx corner : corners) columns.push_back(condition(corner, power));
        if (vanishes(columns)) return true;
        columns.push_back(one());
        return vanishes(std::move(columns));
    }

    static std::vector<idx> cells_of(std::vector<idx> corners)
    {
        for (idx& c : corners) c /= Element::corners;
        return corners;
    }

    /// Of all corners, then of 1 > 0: conditions of length 1, in units of the star, and 1 for their weight.
    std::vector<column> rounded() const
    {
        double size = 0;
        const idx origin = others(corners_.front())[0];
        for (const idx corner : corners_)
            for (const idx v : others(corner)) size = std::max(size, glm::distance(place(v), place(origin)));
        std::vector<column> columns;
        for (const idx corner : corners_)
        {
            auto f = form<double>(corner, [](const vec<D>& a, const vec<D>& b, int k) { return a[k] - b[k]; });
            f.back() /= size;
            double length = 0;
            for (const double x : f) length = std::hypot(length, x);
            for (double& x : f) x = length > 0 ? x / length : 0;
            f.push_back(1);
            columns.push_back(std::move(f));
        }
        auto constant = target();
        std::swap(constant[constant.size() - 2], constant.back());
        columns.push_back(std::move(constant));
        return columns;
    }

    /// The sum vanishes, and the weights of conditions sum to 1.
    column target() const
    {
        column result(unknowns() + 2, 0.0);
        result.back() = 1;
        return result;
    }

    std::size_t unknowns() const
    {
        std::size_t n = 0;
        for (int k = 0; k < D; ++k) n += is_free(k) ? 1 : 0;
        return n;
    }

    /// So many bits make integers of all coordinates.
    int least_power() const
    {
        int power = 0;
        const auto look = [&](idx v)
        {
            for (int k = 0; k < D; ++k) power = std::max(power, big_integer::least_power(place(v)[k]));
        };
        look(static_cast<idx>(vertex_));
        for (const idx corner : corners_)
            for (const idx v : others(corner)) look(v);
        return power;
    }

    std::vector<big_integer> condition(idx corner, int power) const
    {
        return form<big_integer>(corner, [power](const vec<D>& a, const vec<D>& b, int k)
                                 { return big_integer::scaled(a[k], power) - big_integer::scaled(b[k], power); });
    }

    std::vector<big_integer> one() const
    {
        std::vector<big_integer> result(unknowns());
        result.push_back(big_integer::scaled(1, 0));
        return result;
    }

    const untangle_problem<Element>& problem_;
    std::size_t vertex_;
    std::vector<idx> corners_;
};

/// Free vertices without a place: some of their elements whose other corners are pinned contradict each other.
template <class Element>
void judge_stars(const untangle_problem<Element>& p, infeasibility& found)
{
    constexpr std::size_t group = Element::dimension + 2;
    const csr around = vertex_corners(p.rest);
    std::vector<idx> ids;
    for (idx v = 0; v < p.rest.vertex_count(); ++v)
    {
        if (p.held.all(static_cast<std::size_t>(v))) continue;
        const star_conditions<Element> star(p, v, around.row(v));
        if (star.met()) continue;
        auto cells = star.contradiction();
        if (cells.empty()) continue;
        cells.resize(group - 1, cells.back());
        ids.push_back(v);
        ids.insert(ids.end(), cells.begin(), cells.end());
    }
    found.prove(infeasibility_kind::empty_star, std::move(ids),
                [&](const auto& all)
                {
                    std::vector<idx> vertices, cells;
                    for (std::size_t k = 0; k < all.size(); ++k) (k % group == 0 ? vertices : cells).push_back(all[k]);
                    std::sort(cells.begin(), cells.end());
                    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
                    return list_ids("free vertex", "free vertices", vertices) +
                           " whose pinned neighbours leave no place where all their " + Element::names +
                           " are positive, as " + list_first_elements<Element>(cells.size(), cells, p.owners) +
                           " show; move or free a neighbour of each";
                });
}

// Compiled once, with the bodies.
extern template void judge_stars(const untangle_problem<triangle>&, infeasibility&);
extern template void judge_stars(const untangle_problem<tetrahedron>&, infeasibility&);

} // namespace taut::impl
