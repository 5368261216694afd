// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/edit/feature.hpp>
#include <taut/impl/edit/paste_error.hpp>
#include <taut/impl/edit/paste_params.hpp>
#include <taut/impl/edit/paste_report.hpp>
#include <taut/impl/edit/similarity_transform.hpp>
#include <taut/impl/map/map_result.hpp>

namespace taut::impl
{

class pasted;

/// Pin of a vertex of a feature in the map of the target.
struct feature_pin
{
    idx vertex; ///< of the feature's region
    vec2 at;
};

} // namespace taut::impl

namespace taut::io
{

class atomic_file;
struct surface_file;

} // namespace taut::io

/// Cut and paste (paper, section 4). The bodies need Eigen, so taut.hpp does not include it.
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
    map_result parameterize_feature(queue& q, std::span<const impl::feature_pin> pins = {}) const;

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

#ifdef TAUT_IMPLEMENTATION
// First, or the system that they include would include them.
#include <taut/impl/edit/rbf.ipp>

#include <taut/impl/edit/parameterize_feature.ipp>
#include <taut/impl/edit/paste.ipp>
#endif
