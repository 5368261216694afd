// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_START
#endif
#ifndef TAUT_START_MAP_HPP
#define TAUT_START_MAP_HPP

#include <cstddef>
#include <locale>
#include <ostream>
#include <sstream>
#include <vector>

#include <taut/certify.hpp>
#include <taut/quality.hpp>
#include <taut/solve_params.hpp>

/// Initial maps and coarser levels, as reports tell of them.
namespace taut
{

/// Spacing of boundary vertices: uniform, by the boundary edges' lengths, or by the square roots of the lengths.
enum class boundary_spacing
{
    uniform,
    chord,
    centripetal
};

/// Initial map of a surface, with its certificate and distortion.
struct start_map
{
    std::vector<vec2> uv;    ///< one per vertex; (0, 0) for a vertex without a triangle
    certificate flips;       ///< exact count of flipped triangles, range of det S = mapped / rest area
    impl::means distortion;  ///< mean of |S|^2 (1 + 1/det^2): at least 4; infinite if a triangle is flipped or flat
    double residual = 0;     ///< largest |x_i - mean of its neighbours| / sqrt(area): how exactly the system is solved
    std::size_t outline = 0; ///< index of the boundary loop on the polygon, in boundary_loops(mesh)
    std::size_t holes = 0;   ///< the other loops
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

/// Report of one level of a nested iteration.
struct level_report
{
    std::size_t level = 0; ///< 0: the mesh itself
    std::size_t vertices = 0;
    solve::report solve; ///< history left out, but for the finest level
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
