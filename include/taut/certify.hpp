// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_CERTIFY_HPP
#define TAUT_CERTIFY_HPP

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/types.hpp>

/// Certificates in exact arithmetic: flips, branch points, crossings, cells.
namespace taut
{

/// Finds branch points: inner vertices of a surface around which a map winds more than once: the triangles there agree
/// in orientation, but overlap. A map of a disk onto a simple outline without flipped triangles has none.
///
/// Exact: around a vertex v of positive triangles (v, a, b) the link runs counter-clockwise, so it winds once for each
/// edge (a, b) that crosses the horizontal line through v upwards, and whether it does is a comparison of coordinates.
/// Vertices on a boundary, or whose triangles differ in orientation, are not looked at.
///
/// cells: #F by 3 vertex indices, in range; x: one image point per vertex. owners: where triangles are the corners of
/// quads, the cell of each; a quad is an edge of the links of its own corners alone. Ascending.
std::vector<idx> branch_points(std::span<const std::array<idx, 3>> cells, std::span<const vec2> x,
                               std::span<const idx> owners = {});

/// Certificate of local injectivity of a piecewise linear map: no element is flipped, and in the plane no inner vertex
/// is a branch point, one that the map winds around more than once (branch_points.hpp); in space no inner edge is one
/// (branch_edges.hpp). With a simple boundary image the map is injective as a whole.
struct certificate
{
    std::size_t elements = 0; ///< elements examined
    std::size_t flipped = 0;  ///< elements whose determinant is not positive: turned over, flat or not finite; exact
    std::vector<idx> ids{};   ///< the first flipped elements, in ascending order
    std::size_t branched = 0; ///< branch points of a map to the plane, or edges of one to space; exact
    std::vector<idx> branch_ids{}; ///< the first of these vertices, in ascending order; of edges their two ends
    double min_det = 0; ///< smallest det S = mapped / rest measure, signed; 0 if there is no element, NaN if not finite
    double max_det = 0; ///< largest det S

    std::size_t defects() const { return flipped + branched; }

    /// Takes the counts of another certificate; the range of det is kept.
    void take_defects(const certificate& other)
    {
        elements = other.elements;
        flipped = other.flipped;
        ids = other.ids;
        branched = other.branched;
        branch_ids = other.branch_ids;
    }

    explicit operator bool() const { return defects() == 0; }
};

/// Counts flipped elements and branch points in exact arithmetic.
///
/// cells:   #F by D + 1 vertex indices, in range; positive orientation means det[x1 - x0, ..., xD - x0] > 0
/// x:       #V image points
/// measure: #F rest areas or volumes, in the same units as x; empty: det is not divided by anything
/// max_ids: maximum number of flipped elements, and of branch points, to list
/// owners:  where elements are the corners of other cells, the cell of each (mesh/cell_corners.hpp)
template <int D>
certificate certify(std::span<const std::array<idx, D + 1>> cells, std::span<const vec<D>> x,
                    std::span<const double> measure = {}, std::size_t max_ids = 16, std::span<const idx> owners = {});

/// Returns whether the corners of a triangle in space are collinear or not finite: its projections on all three
/// coordinate planes are flat. Exact.
bool collapsed(const vec3& a, const vec3& b, const vec3& c);

/// Number of pairs of boundary edges whose images have a common point beyond a common end vertex: crossings, touchings
/// and overlaps. Exact. 0 together with a clean certificate means that a disk's map is injective.
///
/// loops: boundary loops as vertex indices, each of at least two; x: #V image points, finite.
std::size_t boundary_crossings(std::span<const std::vector<idx>> loops, std::span<const vec2> x);

/// Validity of a cell: the sign of the Jacobian determinant of the map from its reference cell.
enum class cell_validity
{
    valid,    ///< it has: proved
    invalid,  ///< it is not positive at a point of the cell: proved
    undecided ///< neither could be proved to the depth allowed: it is 0 somewhere, or nearly
};

/// Decides whether a cell of four (tetrahedron), five (pyramid), six (wedge) or eight corners (hexahedron), in VTK's
/// order, is valid. Its Jacobian determinant is bounded by its Bernstein coefficients, on ever smaller parts of the
/// cell:
/// Johnen, Remacle and Geuzaine, "Geometrical validity of curvilinear finite elements", 2013. The verdict is rigorous:
/// corners by exact signs, bounds with a bound of all rounding.
///
/// Positive corners alone do not make a hexahedron, wedge or pyramid valid. Of a quad in the plane they do: the
/// determinant of a bilinear map is bilinear, det[x_u, x_v] with x_u linear in v and x_v linear in u, so that its
/// Bernstein coefficients are its values at the four corners.
///
/// boxes: maximum number of subdivisions before the cell is left undecided
cell_validity validity_of_cell(std::span<const vec3> corners, std::size_t boxes = 2000);

} // namespace taut

#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/exact/predicates.hpp>

#endif
#include <taut/impl/leave.inl>
