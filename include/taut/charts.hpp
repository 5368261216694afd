// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_ATLAS
#endif
#ifndef TAUT_CHARTS_HPP
#define TAUT_CHARTS_HPP

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/charts/atlas/seams/seam_arcs.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>
#include <taut/solve_params.hpp>

/// The steps of an atlas: surfaces cut to disks, segmented into charts, flattened; symmetry.
namespace taut
{

/// Surface cut apart into charts: one mesh, with the triangles and the vertices of a chart in one piece, charts in the
/// order of their first triangles, triangles and vertices of a chart in the order of the surface.
struct chart_mesh
{
    mesh<triangle> surface;
    std::vector<idx> first_cell;     ///< #charts + 1
    std::vector<idx> first_vertex;   ///< #charts + 1
    std::vector<idx> cell_origins;   ///< the triangle of the surface, one per triangle; corners keep their places
    std::vector<idx> vertex_origins; ///< the vertex of the surface, one per vertex

    idx charts() const noexcept { return static_cast<idx>(first_cell.size()) - 1; }

    /// The first triangle of a chart, as the surface numbers it.
    idx first_triangle(std::size_t chart) const { return cell_origins[static_cast<std::size_t>(first_cell[chart])]; }
};

/// Cuts a surface apart along seams. Charts are the components connected across other edges, and a vertex becomes one
/// vertex for each fan of its triangles between seams.
/// m:    at most two triangles share an edge
/// seam: one flag per side, the same on both sides of an edge; side 3 t + k is the edge of triangle t opposite its
///       corner k. Boundary edges need no flag
chart_mesh cut_charts(const mesh<triangle>& m, std::span<const char> seam);

/// Computes seams that cut every component of a surface to one disk: handles are cut along short loops, boundaries are
/// joined by short paths, and a closed component without handles is cut along paths between distant points, such as the
/// tips of limbs. Seams prefer creases. For cut_charts().
///
/// m: an oriented manifold. Returns one flag per side, as cut_charts() takes them. Time O(n log n).
std::vector<char> cut_to_disk(const mesh<triangle>& m);

/// Tuning of segmentation.
struct segment_tuning
{
    /// Minimum fill of the convex hull in the plane, 0 to 1: charts of more than a 200th of the area below it are cut,
    /// as branching charts pack badly.
    double least_fill = 0.82;

    /// Maximum number of rounds of cuts, 0 to 100. In each, the new charts are flattened.
    int cut_rounds = 8;

    /// Maximum number of rounds of unions of neighbours, 0 to 100. In each, most of the surface is flattened again.
    /// Small charts are tried once more, unless it is 0.
    int unite_rounds = 1;

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(least_fill >= 0 && least_fill <= 1)) throw parameter_error("least_fill", "must be 0 to 1");
        if (cut_rounds < 0 || cut_rounds > 100) throw parameter_error("cut_rounds", "must be 0 to 100");
        if (unite_rounds < 0 || unite_rounds > 100) throw parameter_error("unite_rounds", "must be 0 to 100");
    }
};

/// Parameters of segment(). Distortions are area means of energy::isometric, 4 at least.
struct segment_params
{
    /// Bound of a chart, above 4. Charts above it are cut further.
    double max_distortion = 4.2;

    /// Bound of the mean over the whole surface, above 4, at one common scale, under which charts are united.
    double mean_distortion = 4.045;

    /// Edges that are to be seams in any case: one flag per side, the same on both sides of an edge; or empty.
    std::span<const char> seams = {};

    /// Edges that are no seams, as the diagonals of a polygon: one flag per side as above; or empty. Seams use them
    /// only where a bound cannot be met otherwise.
    std::span<const char> together = {};

    /// What a unit of length of a seam counts along each side, the same on both sides of an edge; or empty: 1.
    std::span<const double> weights = {};

    /// Not for users: what tests and measurements set.
    segment_tuning tuning = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(max_distortion > 4)) throw parameter_error("max_distortion", "must be above 4, that of no distortion");
        if (!(mean_distortion > 4)) throw parameter_error("mean_distortion", "must be above 4, that of no distortion");
        tuning.validate();
    }
};

/// Report of a segmentation.
struct segment_report
{
    double distortion = 4;   ///< distortion of the whole surface, charts without a map left out
    idx unmapped = 0;        ///< charts without a valid map
    idx above = 0;           ///< charts above max_distortion: of single triangles, or for want of rounds or time
    idx crossing = 0;        ///< charts whose boundary meets itself in the plane
    idx cut = 0, united = 0; ///< charts cut further, pairs united
    double seam_length = 0;  ///< in units of the surface
};

/// Segmentation of a surface into charts, with their maps.
struct segmentation
{
    std::vector<char> seam; ///< one flag per side of the surface; some have one chart on both sides
    chart_mesh charts;
    std::vector<vec2> uv;       ///< one per vertex of charts.surface: as it was flattened
    std::vector<double> energy; ///< one per chart; +infinity where there is no valid map
    segment_report report;
};

/// Cuts a surface into charts that can be flattened within a bound of distortion, few of them, along short seams that
/// follow creases. Every chart is a disk, or one with holes of the surface in it, whatever the surface is: closed, with
/// handles, of several components.
///
/// Pieces are united bottom-up by an estimate of their distortion; then charts are flattened, cut further where they
/// are above the bound, and united where that is possible (cluster_tree.hpp). Deterministic if `flatten` is. Time O(n
/// log n) beside that of `flatten`.
///
/// m: an oriented manifold without flat triangles
/// flatten: callable with a chart_mesh, returns uv (one per vertex), and charts with `valid` and `energy` each. It may
///    take a second argument, std::span<const vec2>, the initial map, and report settled() of charts: then it may
///    return unfinished maps, as many charts are cut anyway. Remaining charts that are not settled are passed again
///    with their maps.
/// limits: then the current charts are returned, or pieces without maps. The observer is asked before each round and
///    within it
/// Throws parameter_error; mesh_error (non_manifold_facet, inconsistent_orientation).
template <class Flatten>
segmentation segment(const mesh<triangle>& m, Flatten&& flatten, const segment_params& params = {},
                     const run_limits& limits = {});

/// Tuning of flatten_charts().
struct flatten_tuning
{
    /// Maximum cost of the factorization of a chart in millions of multiplications; above, the chart is solved by
    /// `parameterize`. The default corresponds to about 5,000 triangles, where both take as long.
    double largest = 30;

    /// True for charts of a rough surface, on which coarser levels say little about finer ones: large charts begin with
    /// a barycentric map, and end as by rough_solve().
    bool rough = false;
};

/// Parameters of flatten_charts(). Every field has a sensible default.
struct flatten_params
{
    /// Stopping tolerance: a chart is done when the predicted decrease of Newton's model is below this fraction of its
    /// energy; 1e-12 to 1. The predicted step is taken, too. With the default, energies end within 1e-4 of their
    /// minima, and mostly within 1e-6.
    double tolerance = 1e-5;

    /// Maximum number of Newton steps of a chart; 0 returns the starts.
    int max_iterations = 100;

    /// Initial map, one point per vertex of the chart mesh in any place and in units of the surface, or empty. Charts
    /// for which it is not valid get another start.
    std::span<const vec2> initial = {};

    /// Not for users: what tests and measurements set.
    flatten_tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const;
};

/// Outcome of flattening one chart.
enum class chart_outcome
{
    converged,  ///< the map is that of least energy, to the tolerance
    stuck,      ///< no step lowers the energy any more: mostly the limit of rounding
    iterations, ///< as many steps as allowed
    stopped,    ///< the time limit or the observer; the map is the best so far
    no_map      ///< there is no valid one: chart_report::reason
};

/// Report of one flattened chart.
struct chart_report
{
    /// Area mean of energy::isometric, 4 at least; +infinity if the map is not valid.
    double energy = std::numeric_limits<double>::infinity();
    double start_energy = std::numeric_limits<double>::infinity(); ///< energy of the initial map
    int iterations = 0;                                            ///< Newton steps
    bool valid = false;     ///< no triangle is flipped, and there is no branch point; in exact arithmetic
    bool multigrid = false; ///< it went to `parameterize`
    chart_outcome outcome = chart_outcome::stopped;
    std::string reason = {}; ///< why there is no valid map

    bool settled() const { return outcome != chart_outcome::iterations; } ///< more steps would be of no use
};

/// Wall-clock seconds of the stages.
struct flatten_seconds
{
    double start = 0;   ///< first maps, on the host
    double device = 0;  ///< kernels built
    double prepare = 0; ///< orders, profiles, transfers
    double solve = 0;   ///< Newton's method
    double large = 0;   ///< charts that `parameterize` mapped
    double certify = 0;
};

/// Result of flatten_charts(): one map for all charts, and a report for each.
struct flattened_charts
{
    using enum chart_outcome; // so that an outcome is flattened_charts::no_map, say

    std::vector<vec2> uv; ///< one per vertex of charts.surface, in units of the surface; (0, 0) where there is no map
    std::vector<chart_report> charts;
    flatten_seconds seconds;
    queue_counters counters; ///< launches, host waits and bytes
};

/// Maps every chart to the plane with a free boundary and the least isometric distortion (energy::isometric by area),
/// without flipping a triangle: all charts at once on the device. Each has its own steps, line search and stopping
/// test, and the number of launches does not depend on the number of charts. Charts lie anywhere in the plane and may
/// overlap.
///
/// A chart is a disk or has holes; closed charts, those with handles and those with a flat triangle have no map. Its
/// map does not depend on other charts. Every map that is returned as valid is certified in exact arithmetic.
/// The observer is asked after each step: progress::iteration counts finished charts, progress::value is the mean
/// energy of the current maps. Throws parameter_error, device_error, build_error.
flattened_charts flatten_charts(queue& q, const chart_mesh& charts, const flatten_params& params = {},
                                const run_limits& limits = {});

/// Error of a surface that is not its own mirror image. what() says which vertices have none in the best plane.
class symmetry_error : public error
{
public:
    /// edges: true if all vertices have images, but edges of these have none
    symmetry_error(const vec3& normal, double offset, std::vector<idx> vertices, bool edges)
        : error(message(normal, offset, vertices, edges)),
          normal_(normal),
          offset_(offset),
          vertices_(std::move(vertices)),
          edges_(edges)
    {
    }

    const vec3& normal() const noexcept { return normal_; }
    double offset() const noexcept { return offset_; }
    const std::vector<idx>& vertices() const noexcept { return vertices_; } ///< ascending
    bool edges() const noexcept { return edges_; }

private:
    static std::string message(const vec3& normal, double offset, const std::vector<idx>& vertices, bool edges);

    vec3 normal_;
    double offset_;
    std::vector<idx> vertices_;
    bool edges_;
};

/// Plane of symmetry of a surface, vertex by vertex and polygon by polygon.
struct mirror_symmetry
{
    vec3 normal{0.0};  ///< unit normal of the plane
    double offset = 0; ///< the plane has the points x with dot(normal, x) = offset

    std::vector<idx> vertex;  ///< the image of each vertex; itself on the plane
    std::vector<idx> side;    ///< the image of each side, which runs the other way; -1 within polygons
    std::vector<idx> polygon; ///< polygon of each triangle, by the first of its triangles
    impl::csr triangles;      ///< triangles of each polygon
    std::vector<idx> image;   ///< image of each polygon: itself where it lies across the plane

    /// The corner at the image of the vertex of corner k of triangle c, in the image of its polygon. Triangles need not
    /// have images, as a polygon and its image may be cut along other diagonals.
    idx corner(const mesh<triangle>& m, idx c, idx k) const
    {
        const auto u = [](idx i) { return static_cast<std::size_t>(i); };
        const idx v = vertex[u(m.cells()[u(c)][u(k)])];
        for (const idx t : triangles.row(image[u(polygon[u(c)])]))
            for (idx j = 0; j < 3; ++j)
                if (m.cells()[u(t)][u(j)] == v) return 3 * t + j;
        return -1; // never: polygons and their images have the same sides
    }
};

/// Finds a plane in which a surface is its own mirror image.
/// together:  diagonals of polygons, as in segment_params: they need no images
/// tolerance: maximum distance of a vertex from the image of another one, relative to the diagonal of the box
/// Throws symmetry_error if there is none.
mirror_symmetry find_symmetry(const mesh<triangle>& m, std::span<const char> together = {}, double tolerance = 1e-4);

} // namespace taut

#include <taut/impl/charts/atlas/segment.hpp>

#endif
#include <taut/impl/leave.inl>
