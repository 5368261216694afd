// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/map/constraints.hpp>

namespace taut::detail
{

/// Turns, scales and shifts a map so that it comes closest to what its constraints ask, in the sense of least squares:
/// of two or more pinned vertices; else of these and the springs. One vertex shifts the map, none leaves it. Targets
/// that no similarity explains, and which would shrink the map to nothing, only turn and shift it.
inline void fit_similarity(std::vector<vec2>& uv, const constraints<triangle>& wanted)
{
    using complex = std::complex<double>;
    struct anchor
    {
        complex from, to;
        double weight;
    };
    const auto at = [](const vec2& p) { return complex(p.x, p.y); };
    std::vector<anchor> anchors;
    for (const auto& [v, p] : wanted.pins())
        if (p.held == constraints<triangle>::all)
            anchors.push_back({at(uv[static_cast<std::size_t>(v)]), at(p.value), 1.0});
    if (anchors.size() < 2)
    {
        double heaviest = 0;
        for (const auto& s : wanted.springs()) heaviest = std::max(heaviest, s.weight);
        for (const auto& s : wanted.springs())
            if (s.weight > 0)
                anchors.push_back({at(uv[static_cast<std::size_t>(s.vertex)]), at(s.target), s.weight / heaviest});
    }
    if (anchors.empty()) return;

    complex from, to;
    double total = 0;
    for (const auto& a : anchors)
    {
        from += a.weight * a.from;
        to += a.weight * a.to;
        total += a.weight;
    }
    from /= total, to /= total;
    complex product;
    double spread = 0, wanted_spread = 0;
    for (const auto& a : anchors)
    {
        product += a.weight * std::conj(a.from - from) * (a.to - to);
        spread += a.weight * std::norm(a.from - from);
        wanted_spread += a.weight * std::norm(a.to - to);
    }
    complex turn(1);
    if (std::abs(product) > 0 && std::isfinite(std::abs(product)))
    {
        const bool explained = std::norm(product) > 0.25 * spread * wanted_spread;
        turn = explained ? product / spread : product / std::abs(product);
    }
    for (vec2& p : uv)
    {
        const complex z = to + turn * (at(p) - from);
        p = {z.real(), z.imag()};
    }
}

} // namespace taut::detail
