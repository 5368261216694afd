// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <span>

#include <taut/types.hpp>

namespace taut::impl
{

/// Similarity of the plane, z -> to + turn (z - from) in complex numbers.
struct similarity
{
    std::complex<double> from = 0, to = 0, turn = 1;

    vec2 operator()(const vec2& p) const
    {
        const auto z = to + turn * (std::complex<double>(p.x, p.y) - from);
        return {z.real(), z.imag()};
    }
};

/// Point and its target.
struct anchor
{
    vec2 from, to;
    double weight = 1;
};

/// Fits the similarity that takes anchors to their targets in the sense of least squares.
struct similarity_fit
{
    similarity map;       ///< its turn is 0 where the anchors fix none: fewer than two, or all in one place
    double explained = 0; ///< the part of the spread of the places that it accounts for, 0..1
};

/// At least one anchor; weights are positive.
inline similarity_fit fit_similarity(std::span<const anchor> anchors)
{
    using complex = std::complex<double>;
    const auto at = [](const vec2& p) { return complex(p.x, p.y); };
    similarity_fit fit;
    double total = 0;
    for (const anchor& a : anchors)
    {
        fit.map.from += a.weight * at(a.from);
        fit.map.to += a.weight * at(a.to);
        total += a.weight;
    }
    fit.map.from /= total;
    fit.map.to /= total;
    complex product;
    double spread = 0, wanted = 0;
    for (const anchor& a : anchors)
    {
        const complex p = at(a.from) - fit.map.from, q = at(a.to) - fit.map.to;
        product += a.weight * std::conj(p) * q;
        spread += a.weight * std::norm(p);
        wanted += a.weight * std::norm(q);
    }
    fit.map.turn = spread > 0 ? product / spread : complex(0);
    if (spread > 0 && wanted > 0) fit.explained = std::norm(product) / spread / wanted;
    return fit;
}

} // namespace taut::impl
