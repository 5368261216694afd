// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/edit/feature.hpp>
#include <taut/impl/edit/paste_error.hpp>
#include <taut/impl/edit/paste_params.hpp>
#include <taut/impl/edit/paste_report.hpp>
#include <taut/impl/edit/similarity_transform.hpp>

namespace taut::impl
{

class pasted;

} // namespace taut::impl

/// Cut and paste (paper, section 4). The bodies need Eigen, so taut.hpp does not include it.
namespace taut
{

/// A feature pasted on a surface. The constructor looks for the place of the rim, makes room for it, fills the gap and
/// factors the systems of the fields that bend both sides of the seam. pose() then moves, turns and scales the feature
/// while it stays attached, at the cost of back-substitutions and kernels.
///
///     taut::paste p(queue, target, taut::make_feature(taut::geodesic_disk(source, v, radius)), onto);
///     p.pose({.turn = 0.3, .softness = 0.5});
///     const auto result = p.surface();                // to be written, or the target of the next one
///
/// The target is kept: surface() of none of its poses changes it, and target() undoes the paste. Triangles of the
/// result: those of the target that are left, in their order; those of the gap; those of the feature. Vertices: those
/// of the target that are left, in their order; those of the feature. Where the target was manifold, the result is, and
/// no boundary is added. Not to be used from two threads at once. Objects may be moved, not copied.
class paste
{
public:
    using cell = mesh<triangle>::cell;

    /// Throws region_error where the surroundings of vertex `onto` are no disk, paste_error where the rim does not fit
    /// there, parameter_error, mesh_error, device_error.
    paste(queue& q, mesh<triangle> target, feature part, idx onto, const paste_params& params = {});
    paste(paste&&) noexcept;
    paste& operator=(paste&&) noexcept;
    ~paste();

    /// Puts the feature elsewhere. What it is attached to stays: for a way across the surface that is longer than some
    /// edges, and for a turn of more than some twenty degrees, paste anew. The first soft one maps the feature. Throws
    /// paste_error where that fails.
    paste& pose(const paste_pose& to);

    /// Puts another surface within the same rim, say a tessellation of the feature's map. Throws parameter_error for
    /// another rim.
    paste& refill(feature part);

    const paste_pose& pose() const;

    const std::vector<vec3>& points() const; ///< of the result; pose() changes them
    const std::vector<cell>& cells() const;  ///< of the result; they stay
    mesh<triangle> surface() const;

    const mesh<triangle>& target() const; ///< as it was

    /// The vertex of the target that vertex v of the result was, or -1: it is one of the feature.
    const std::vector<idx>& origins() const;
    const std::vector<idx>& kept_faces() const; ///< of the target: triangle f was kept_faces()[f]
    const feature& part() const;
    const std::vector<vec2>& rim_uv() const; ///< of its rim, in the map of the target
    idx first_gap() const;                   ///< triangle of the gap; those before are of the target
    idx first_feature() const;               ///< triangle of the feature; the rest is, too

    /// Where the pose takes points of the source, but for the softness.
    similarity_transform transform() const;

    const paste_report& report() const;

    /// Pairs of triangles of the result that meet elsewhere than in what they share, but for those that did so in the
    /// target or in the feature; exact (see taut::self_intersections).
    std::vector<std::array<idx, 2>> self_intersections() const;

    /// Edges of gap and feature where triangles of the result turn back by more than 150 degrees, and not by nearly as
    /// much in the feature: the two triangles of each.
    std::vector<std::array<idx, 2>> folds() const;

    /// Where the pose has folds(): takes the nearest softness without, of those below it in quarters, then of those
    /// above. False where there are some at each: the pose is as before then.
    bool unfold();

private:
    std::unique_ptr<impl::pasted> body_;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/edit/paste.ipp>
#include <taut/impl/edit/rbf.ipp>
#endif
