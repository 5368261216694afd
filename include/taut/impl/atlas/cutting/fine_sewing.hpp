// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include <taut/impl/atlas/cutting/laid_part.hpp>
#include <taut/impl/atlas/cutting/sew_tips.hpp>

namespace taut::impl
{

/// Sews up seams of charts that have a map, on the surface itself, until they are at a bound of their mean energy.
/// kept: sides that stay seams, or empty; factors: what a unit of length of a seam counts along each side, or empty
/// Returns whether something has changed.
inline bool sew_laid(const mesh<triangle>& m, const laid_seams& laid, std::span<const char> kept, double bound,
                     const std::function<bool()>& proceed, std::span<const double> factors = {})
{
    laid_part own = laid_part::of(m, laid, kept, factors);
    const rest_surface& rest = own.rest;
    flat_surface& flat = own.flat;
    constexpr idx most = 16'000; // triangles of which the whole map may follow
    const bool whole = laid.whole && rest.triangles() <= most;
    const auto before = seam_price(rest, flat.seam);
    const sewing how{.bound = bound,
                     .patch = whole ? std::size_t{120} : std::size_t{300},
                     .keep_apart = true,
                     .whole = whole,
                     .proceed = proceed,
                     .told = {}};
    tip_sewing(rest, flat, how).run();
    if (!(seam_price(rest, flat.seam) < before)) return false;
    own.write(laid);
    return true;
}

} // namespace taut::impl
