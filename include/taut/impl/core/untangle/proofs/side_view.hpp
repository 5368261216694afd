// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/untangle/proofs/big_integer.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Flat side of a pinned outline: the pinned vertices of one coordinate, beyond which there are none.
struct flat_side
{
    int axis = 0;
    double at = 0;
    int inward = 1; ///< the sign of what the others have more
};

/// Condition of a positive tetrahedron on the positions of an edge and a third vertex: a polynomial of degree 1 or 2
/// without other terms is positive. Exact but for a positive factor, and rounded.
struct place_form
{
    int degree = 0; ///< 0: none that is of use
    std::vector<big_integer> exact;
    std::vector<double> rounded; ///< of length 1
};

/// Tetrahedra seen from a flat side. A projective map takes the side to infinity and keeps orientations: of its
/// vertices directions are left, (x, y, 1) in its plane, and others have places (x, y, 1) / height. Tetrahedra with two
/// corners a, b on the side are linear in the two other places, (a x b).(u - v) > 0, those with one corner
/// bilinear in differences of places, a.((u - w) x (v - w)) > 0.
///
/// Here all is in terms of two differences: e = second - first, the ends of an edge, and v = third - first.
class side_view
{
public:
    static constexpr std::size_t unknowns = 6; ///< e, then v
    static constexpr std::size_t products = unknowns * (unknowns + 1) / 2;
    using tetra = std::array<idx, 4>;

    /// corners: all vertices of the side that tetrahedra will have.
    side_view(const untangle_problem<tetrahedron>& p, const flat_side& side, idx first, idx second,
              std::span<const idx> corners)
        : problem_(p), side_(side), first_(first), second_(second), origin_(corners[0])
    {
        std::array<int, 2> bits{};
        for (int k = 0; k < 2; ++k)
        {
            double size = 0;
            int& power = power_[static_cast<std::size_t>(k)];
            for (const idx v : corners)
            {
                size = std::max(size, std::abs(along(v, k) - along(origin_, k)));
                power = std::max(power, big_integer::least_power(along(v, k)));
            }
            bits[static_cast<std::size_t>(k)] = size > 0 ? std::ilogb(size) + power : 0;
        }
        bits_ = std::max(bits[0], bits[1]);
        for (std::size_t k = 0; k < 2; ++k) power_[k] += bits_ - bits[k];
    }

    bool on_side(idx v) const
    {
        const auto k = static_cast<std::size_t>(v);
        return problem_.held.all(k) && problem_.initial[k][side_.axis] == side_.at;
    }

    /// The vertex that the tetrahedron has besides those of the side and the ends of the edge; -1: none. Nothing where
    /// it has more of them, or a pinned one elsewhere.
    std::optional<idx> third(const tetra& t) const
    {
        idx found = -1;
        for (const idx v : t)
        {
            if (v == first_ || v == second_ || on_side(v)) continue;
            if (found >= 0 || problem_.held.any(static_cast<std::size_t>(v))) return std::nullopt;
            found = v;
        }
        return found;
    }

    /// Condition for a tetrahedron to be positive. Of degree 0 unless it has one or two corners on the side.
    const place_form& form(const tetra& t)
    {
        const auto [at, added] = forms_.try_emplace(t);
        if (added) at->second = make_form(t);
        return at->second;
    }

    /// The product of two linear forms, exact.
    static std::vector<big_integer> product(const place_form& f, const place_form& g)
    {
        std::vector<big_integer> result;
        for (std::size_t i = 0; i < unknowns; ++i)
            for (std::size_t j = i; j < unknowns; ++j)
                result.push_back(i == j ? f.exact[i] * g.exact[i] : f.exact[i] * g.exact[j] + f.exact[j] * g.exact[i]);
        return result;
    }

private:
    using direction = std::array<big_integer, 3>;

    double along(idx v, int k) const { return problem_.initial[static_cast<std::size_t>(v)][(side_.axis + 1 + k) % 3]; }

    /// The direction of a vertex on the side, (x, y, 1) from one of them on, in whole numbers: each in a unit, a power
    /// of two, in which all of them are of about the same size.
    direction direction_of(idx v) const
    {
        direction d;
        for (int k = 0; k < 2; ++k)
        {
            const int power = power_[static_cast<std::size_t>(k)];
            d[static_cast<std::size_t>(k)] =
                big_integer::scaled(along(v, k), power) - big_integer::scaled(along(origin_, k), power);
        }
        d[2] = big_integer::scaled(1, bits_);
        return d;
    }

    place_form make_form(const tetra& t)
    {
        // Corners of the side first, then those of the others in an order of the same orientation.
        tetra order = t;
        bool turned = side_.inward < 0;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t j = 0; j + 1 < 4; ++j)
                if (!on_side(order[j]) && on_side(order[j + 1]))
                {
                    std::swap(order[j], order[j + 1]);
                    turned = !turned;
                }
        const auto corners = std::count_if(order.begin(), order.end(), [this](idx v) { return on_side(v); });
        place_form f;
        if (corners == 2)
        {
            const direction a = direction_of(order[0]), b = direction_of(order[1]);
            f.degree = 1;
            f.exact.resize(unknowns);
            for (std::size_t k = 0; k < 3; ++k)
            {
                const big_integer n = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
                add(f.exact, order[2], k, turned ? -n : n);
                add(f.exact, order[3], k, turned ? n : -n);
            }
        }
        else if (corners == 1)
        {
            // The ends of the edge and the third vertex, in some order: a.(e x v) or its negative.
            const direction a = direction_of(order[0]);
            const auto at = [&](idx v) { return std::find(order.begin() + 1, order.end(), v) - order.begin() - 1; };
            const bool even = (at(second_) - at(first_) + 3) % 3 == 1;
            f.degree = 2;
            f.exact.resize(products);
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
                const bool negative = turned == even;
                f.exact[packed(i, 3 + j)] = negative ? -a[k] : a[k];
                f.exact[packed(j, 3 + i)] = negative ? a[k] : -a[k];
            }
        }
        round(f);
        return f;
    }

    /// Adds a multiple of a coordinate of a place.
    void add(std::vector<big_integer>& to, idx v, std::size_t k, const big_integer& n) const
    {
        if (v == first_) return; // the origin
        auto& x = to[(v == second_ ? 0U : 3U) + k];
        x = x + n;
    }

    static std::size_t packed(std::size_t i, std::size_t j) { return i * unknowns - i * (i + 1) / 2 + j; }

    static void round(place_form& f)
    {
        int bits = 0;
        for (const auto& x : f.exact) bits = std::max(bits, x.bits());
        double length = 0;
        for (const auto& x : f.exact) f.rounded.push_back(x.rounded(bits));
        for (const double x : f.rounded) length += x * x;
        for (double& x : f.rounded) x /= std::sqrt(length);
    }

    const untangle_problem<tetrahedron>& problem_;
    flat_side side_;
    idx first_, second_, origin_;
    std::array<int, 2> power_{0, 0}; // of two, by which coordinates are multiplied
    int bits_ = 0;                   // of directions
    std::map<tetra, place_form> forms_;
};

} // namespace taut::impl
