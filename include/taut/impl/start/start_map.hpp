// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <locale>
#include <ostream>
#include <sstream>
#include <vector>

#include <taut/impl/energy/distortion.hpp>
#include <taut/impl/exact/certify.hpp>

namespace taut::impl
{

/// Initial map of a surface, with its certificate and distortion.
struct start_map
{
    std::vector<vec2> uv;    ///< one per vertex; (0, 0) for a vertex without a triangle
    certificate flips;       ///< exact count of flipped triangles, range of det S = mapped / rest area
    means distortion;        ///< mean of |S|^2 (1 + 1/det^2): at least 4; infinite if a triangle is flipped or flat
    double residual = 0;     ///< largest |x_i - mean of its neighbours| / sqrt(area): how exactly the system is solved
    std::size_t outline = 0; ///< index of the boundary loop on the polygon, in boundary_loops(mesh)
    std::size_t holes = 0;   ///< the other loops

    /// Fills `flips` and `distortion`; `ideal` in the units of uv.
    void assess(const mesh<triangle>& m, const ideal_elements<triangle>& ideal)
    {
        flips = certify<2>(m.cells(), uv, ideal.measure);
        distortion = mean_over<triangle>(m, ideal, uv, [](const auto& e) { return bounded(energy::isometric{}, e); });
    }
};

inline std::ostream& operator<<(std::ostream& out, const start_map& map)
{
    std::ostringstream line;
    line.imbue(std::locale::classic());
    line << "start: " << map.flips.flipped << " of " << map.flips.elements << " triangles flipped, det "
         << map.flips.min_det << " .. " << map.flips.max_det << ", E " << map.distortion.measure << " by area, "
         << map.distortion.uniform << " mean";
    return out << line.str();
}

} // namespace taut::impl
