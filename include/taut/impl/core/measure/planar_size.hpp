// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

namespace taut::impl
{

/// True if the energy is scale-invariant, as the shape energy: the scale of a map is then free.
inline bool is_scale_invariant(const any_energy& energy)
{
    const mat2 S(1.1, 0.2, -0.3, 0.9);
    const auto at = [&](double s) { return energy(element<double, 2>{s * S, s * s * glm::determinant(S), 1.0}); };
    return std::abs(at(3.0) - at(1.0)) < 1e-9 * std::abs(at(1.0));
}

/// The smallest box around some points: its centre and its largest side.
template <int D>
struct bounding_box
{
    vec<D> centre{0.0};
    double size = 0;

    explicit bounding_box(const std::vector<vec<D>>& points)
    {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        vec<D> least(infinity), most(-infinity);
        for (const vec<D>& p : points) least = glm::min(least, p), most = glm::max(most, p);
        centre = least / 2.0 + most / 2.0; // the sum may overflow
        for (int k = 0; k < D; ++k) size = std::max(size, most[k] - least[k]);
    }
};
using bounding_square = bounding_box<2>;

/// Scales by a power of two, so that the map's extent is that of a square with this area.
inline void bring_to_size(std::vector<vec2>& uv, double area)
{
    const double size = bounding_square(uv).size, wanted = std::sqrt(area);
    if (!(size > 0) || !std::isfinite(size)) return;
    const int power = std::ilogb(wanted) - std::ilogb(size);
    for (vec2& p : uv) p = {std::ldexp(p.x, power), std::ldexp(p.y, power)};
}

/// Scales a map to the area of the surface.
inline void keep_total_area(const mesh<triangle>& m, const ideal_elements<triangle>& ideal, std::vector<vec2>& uv)
{
    double rest = 0, mapped = 0;
    for (std::size_t c = 0; c < ideal.measure.size(); ++c)
    {
        rest += ideal.measure[c];
        const auto& t = m.cells()[c];
        const auto at = [&](std::size_t k) { return uv[static_cast<std::size_t>(t[k])]; };
        mapped += triangle::measure_factor * triangle::determinant({at(0), at(1), at(2)});
    }
    const double s = std::sqrt(rest / mapped);
    if (std::isfinite(s) && s > 0)
        for (auto& p : uv) p *= s;
}

} // namespace taut::impl
