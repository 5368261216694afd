// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_PASTE
#endif
#ifndef TAUT_PASTE_HPP
#define TAUT_PASTE_HPP

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/charts/paste/paste_report.hpp>
#include <taut/impl/charts/paste/rbf_basis.hpp>
#include <taut/impl/charts/paste/similarity_transform.hpp>
#include <taut/mesh.hpp>
#include <taut/options.hpp>
#include <taut/parameterize.hpp>
#include <taut/queue.hpp>
#include <taut/types.hpp>

/// Cut and paste: regions, features, and pasting a feature onto another surface.
namespace taut::impl
{

class pasted;
struct feature_map;

} // namespace taut::impl

namespace taut
{

/// Reasons why a part of a surface is no disk. The comment says what region_error::ids() holds, in numbers of the
/// surface.
struct region_faults
{
    enum fault_kind
    {
        empty,              ///< no triangle; the vertex that was asked for, if there is one
        out_of_range,       ///< vertices or triangles that are not there
        not_a_loop,         ///< vertices of a loop where it leaves the edges, or all where it does not part the surface
        several_components, ///< one triangle of each
        pinched,            ///< vertices where it touches itself
        no_boundary,        ///< no ids: it is the whole surface
        several_boundaries, ///< one vertex of each boundary loop
        handles,            ///< no ids
        flat                ///< no ids: its rim encloses no area, so that its base has no direction
    };
};

/// Fault of regions: a constant of region_error, such as region_error::flat.
using region_fault = region_faults::fault_kind;

/// Error of a region that cannot be cut out as a disk. what() has the reason and the remedy.
class region_error : public region_faults, public fault_error<region_fault>
{
public:
    using fault_error::fault_error;
};

/// Error of a feature that cannot be placed on a surface. what() has the reason and the remedy.
class paste_error : public error
{
public:
    using error::error;
};

/// Region of a surface with disk topology, as a mesh of its own.
struct surface_region
{
    mesh<triangle> surface;    ///< the region as a mesh of its own
    std::vector<idx> vertices; ///< vertex v of the region is vertices[v] of the whole surface; increasing
    std::vector<idx> faces;    ///< the same for its triangles
    std::vector<idx> rim;      ///< the boundary loop, in numbers of the region, with the region to its left
};

/// Makes a region of these triangles. Throws region_error where it is no disk, mesh_error where the surface is not
/// manifold and oriented.
surface_region region_of_faces(const mesh<triangle>& m, std::span<const idx> faces);

/// Geodesic disk: the triangles around a vertex whose corners are within a geodesic distance of it, in the units of the
/// surface. Enclosed holes are filled where they have fewer triangles than the disk; where the disk touches itself at a
/// vertex, the smaller side is left out; triangles with two sides on the rim are added or removed. Throws as
/// region_of_faces.
surface_region geodesic_disk(const mesh<triangle>& m, idx centre, double radius);

/// Region to the left of a closed loop of edges, named by its vertices in their order. Throws as region_of_faces.
surface_region region_inside(const mesh<triangle>& m, std::span<const idx> loop);

} // namespace taut

namespace taut::impl
{

struct feature_map;

} // namespace taut::impl

namespace taut
{

class queue;

/// Feature cut from one surface to be pasted on another: a region with its base. The base is the plane fitted to the
/// rim; the displacement of the region from it is the detail.
struct feature
{
    /// Takes a region. Throws region_error for one whose rim encloses no area: its base has no normal.
    explicit feature(surface_region of);

    surface_region
        region;           ///< edges between vertices of the rim are halved: their middles are vertices -1 of the source
    vec3 centre{0.0};     ///< mean of the rim by length
    vec3 normal{0, 0, 1}; ///< unit normal of the base, to the outside
    double radius = 0;    ///< largest distance of the rim from the centre

    /// The axes of the base and its normal, as columns; right-handed.
    mat3 frame() const
    {
        const vec3 across = std::abs(normal.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        const vec3 first = glm::normalize(glm::cross(across, normal));
        return {first, glm::cross(normal, first), normal};
    }

    /// Rasterizes the feature over a map of it, on the device. uv: one per vertex of the region, injective. resolution:
    /// texels along the longer side, 8 to 8192. The result is continued by some texels beyond the rim. Throws
    /// parameter_error, device_error.
    impl::feature_map rasterize(queue& q, std::span<const vec2> uv, idx resolution = 512) const;

    /// Remeshes the feature from a map: the rim is kept, and the density of the triangles inside follows the detail of
    /// the map (paper, section 4.1, whose tessellation shader does the same). The plane within the rim is split into
    /// square cells, the roughest first, until half of the triangles are spent or nothing is rougher than a hundredth
    /// of a texel's footprint; their middles and the rim get a constrained Delaunay triangulation, which has no cracks
    /// between coarse and fine; its vertices are offset by the map. Roughness and positions are computed on the device.
    /// A map cuts off creases, and where it squeezes the feature its texels are far apart: there the feature's own
    /// vertices, and middles of its edges, come in instead, the farthest first, until both are within a quarter of a
    /// footprint or the triangles are spent.
    ///
    /// uv: those that the map was made with. The vertices inside and all triangles are none of the source (-1). Throws
    /// parameter_error, paste_error where the rim crosses itself in uv.
    feature tessellate(queue& q, const impl::feature_map& map, std::span<const vec2> uv, idx triangles) const;
};

/// Pose of a feature on the target: by default, the smallest rotation takes the normal of its base to the normal of the
/// target, half of its rim above the surface and half below.
struct paste_pose
{
    double turn = 0;     ///< about the target's normal, in radians, counter-clockwise as seen from outside
    double scale = 1;    ///< lengths of the pasted feature by those of the source
    vec3 shift{0.0};     ///< in the units of the target
    double softness = 0; ///< 0: the feature keeps its shape, the target bends to meet it; 1: the rim lies on the
                         ///< target, the feature bends; between: between

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!std::isfinite(turn)) throw parameter_error("turn", "must be a number");
        if (!(scale > 0) || !std::isfinite(scale)) throw parameter_error("scale", "must be a positive number");
        if (!(softness >= 0 && softness <= 1)) throw parameter_error("softness", "must be from 0 to 1");
        if (!std::isfinite(shift.x) || !std::isfinite(shift.y) || !std::isfinite(shift.z))
            throw parameter_error("shift", "must be numbers");
    }
};

/// Tuning of a paste.
struct paste_tuning
{
    /// Basis of the fields that bend target and feature. `linear` overshoots least.
    impl::rbf_basis basis = impl::rbf_basis::linear;

    /// Maximum number of control points of each kind: along the rim, and fixed ones.
    idx controls = 300;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (controls < 8) throw parameter_error("controls", "must be at least 8");
        rbf_value(basis, 0, 1);
    }
};

/// Parameters of a paste. Every field has a sensible default.
struct paste_params
{
    paste_pose pose = {}; ///< initial pose of the feature

    /// Radius of the region of the target that may bend, relative to that of the scaled rim: 1.2 or more. Triangles
    /// under the rim are replaced.
    double reach = 1.8;

    /// Not for users: what tests and measurements set.
    paste_tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        pose.validate();
        if (!(reach >= 1.2) || !std::isfinite(reach)) throw parameter_error("reach", "must be 1.2 or more");
        tuning.validate();
    }
};

} // namespace taut

namespace taut::impl
{

class pasted;

} // namespace taut::impl

namespace taut
{

/// Pin of a vertex of a feature in the map of the target.
struct feature_pin
{
    idx vertex; ///< of the feature's region
    vec2 at;
};

} // namespace taut

namespace taut::io
{

class atomic_file;

struct surface_file;

} // namespace taut::io

namespace taut
{

/// Paste of a feature on a surface. The constructor projects the rim, removes triangles of the target, fills the gap
/// and factors the systems of the fields that bend both sides of the seam. pose() then translates, rotates and scales
/// the attached feature, at the cost of back-substitutions and kernels.
///
///     taut::paste p(queue, target, taut::feature(taut::geodesic_disk(source, v, radius)), onto);
///     p.pose({.turn = 0.3, .softness = 0.5});
///     const auto result = p.surface();                // to be written, or the target of the next one
///
/// The original target is kept: target() undoes the paste. Triangles of the result: the remaining ones of the target,
/// in their order; those of the gap; those of the feature. Vertices: the remaining ones of the target, in their order;
/// those of the feature. The result is manifold if the target was, and no boundary is added. Not to be used from two
/// threads at once. Objects may be moved, not copied.
class paste
{
public:
    using cell = mesh<triangle>::cell;

    /// Pastes a feature at vertex `onto`. Throws region_error where its neighbourhood is no disk, paste_error where the
    /// rim does not fit there, parameter_error, mesh_error, device_error. limits: of the map of the feature to the
    /// target, for the first soft pose: a rim that is hard to fit takes an untangling, which may not end.
    paste(queue& q, mesh<triangle> target, feature part, idx onto, const paste_params& params = {},
          const run_limits& limits = {.time_limit = std::chrono::seconds(20)});
    paste(paste&&) noexcept;
    paste& operator=(paste&&) noexcept;
    ~paste();

    /// Changes the pose of the feature. Its correspondences are kept: for a move of more than some edges, and for a
    /// rotation of more than some twenty degrees, paste anew. The first soft pose maps the feature. Throws paste_error
    /// where that fails.
    paste& pose(const paste_pose& to);

    /// Replaces the feature by another surface with the same rim, say a tessellation of its map. Throws parameter_error
    /// for another rim.
    paste& refill(feature part);

    const paste_pose& pose() const;

    const std::vector<vec3>& points() const; ///< points of the result; pose() changes them
    const std::vector<cell>& cells() const;  ///< triangles of the result; they stay
    mesh<triangle> surface() const;

    const mesh<triangle>& target() const; ///< as it was

    /// Vertex of the target that vertex v of the result comes from, or -1 for those of the feature.
    const std::vector<idx>& origins() const;
    const std::vector<idx>& kept_faces() const; ///< of the target: triangle f was kept_faces()[f]
    const feature& part() const;
    const std::vector<vec2>& rim_uv() const; ///< its rim in the map of the target
    idx first_gap() const;                   ///< triangle of the gap; those before are of the target
    idx first_feature() const;               ///< triangle of the feature; the rest is, too

    /// Similarity transform of the pose, without softness.
    impl::similarity_transform transform() const;

    const impl::paste_report& report() const;

    /// Measures the result: whether it is manifold, its boundary, degenerate triangles, angles across the rim.
    impl::seam_quality measure_seam() const;

    /// New self-intersections: pairs of triangles of the result that meet elsewhere than in what they share, and did
    /// not in the target or in the feature; exact (see taut::self_intersections).
    std::vector<std::array<idx, 2>> self_intersections() const;

    /// Edges of gap and feature where triangles of the result turn back by more than 150 degrees, and not by nearly as
    /// much in the feature: the two triangles of each.
    std::vector<std::array<idx, 2>> folds() const;

    /// Removes folds() of the pose: takes the nearest softness without, of those below it in quarters, then of those
    /// above. Returns false, and keeps the pose, if each has folds.
    bool unfold();

    /// Maps the feature into the map of the target (paper, section 4.1): its rim is pinned to the correspondences of
    /// the paste, with any other vertices that are named, and the rest is mapped as isometrically as that allows,
    /// without flips. The rim is a simple polygon, so without other pins there is a map; where these contradict it, the
    /// outcome is infeasible, and report.ids names the triangles or vertices. Throws constraint_error, device_error.
    map_result parameterize_feature(queue& q, std::span<const feature_pin> pins = {}) const;

    /// Writes the result as OBJ, with values that read back bit for bit. Triangles of the target keep its texture
    /// coordinates and those of the feature that of its source, if these have any; vt of the target come first, in
    /// their order. Triangles of the gap, and those that were split, have none.
    /// target, source: the files that both were read from. Throws io_error.
    void write(io::atomic_file& out, const io::surface_file& target, const io::surface_file& source) const;
    void write(const std::filesystem::path& path, const io::surface_file& target, const io::surface_file& source) const;

private:
    std::unique_ptr<impl::pasted> body_;
};

} // namespace taut

#include <taut/impl/charts/paste/feature_map.hpp>
#include <taut/impl/charts/paste/geodesic_distances.hpp>
#include <taut/impl/charts/paste/rbf.hpp>
#include <taut/impl/charts/paste/self_intersections.hpp>
#include <taut/impl/charts/paste/write_feature_map.hpp>
#include <taut/impl/charts/paste/write_paste.hpp>

#endif
#include <taut/impl/leave.inl>
