// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_DEFORM
#endif
#ifndef TAUT_DEFORM_HPP
#define TAUT_DEFORM_HPP

#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/cell_data.hpp>
#include <taut/certify.hpp>
#include <taut/constraints.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/core/start/shape_path.hpp>
#include <taut/options.hpp>
#include <taut/session.hpp>
#include <taut/solve_params.hpp>
#include <taut/untangle.hpp>

/// Deforms volumes, shells and planar meshes by pins.
namespace taut
{

/// Parameters of deform() and of sessions of volumes and planar meshes. Every field has a sensible default.
template <class Element>
struct deform_params
{
    static constexpr int D = Element::dimension;

    /// Energy to be minimised. A user's struct converts, alone or with parameters, as {cloth{}, {0.5}}; so do sums and
    /// products of energies.
    any_energy energy = default_energy();

    /// Weights of elements in the sum: rest measure, as is usual, or all equal.
    energy::weighting weights = energy::weighting::measure;

    /// Data of single elements that energies read, in the order of the mesh.
    cell_data data = {};

    /// Pins, which are met bit for bit, and springs.
    taut::constraints<Element> constraints = {};

    /// True if the target shape of elements is a regular one, of the mean size, and the mesh has no rest shape.
    bool regular = false;

    /// Target shapes of single elements: the edges of each from its corner 0, as columns, up to a rotation. Empty, or
    /// one per element, none of them inverted. They are in the lengths of the mesh, in the place of the elements at
    /// rest; in the place of `regular` ones all are scaled to the size of the mesh.
    std::vector<mat<D>> targets = {};

    /// Owners of simplices that are the corners of cells of other kinds, and overlap (mesh/cell_corners.hpp).
    /// Certificates then say that all corners are positive.
    std::vector<idx> owners = {};

    /// Sliding constraints, at most one per vertex, none of a vertex with a pinned coordinate.
    std::vector<slide<D>> slides = {};

    /// Initial shape, if it is not that of the mesh, which is the one at rest: of the last step, say.
    std::vector<vec<D>> initial = {};

    taut::precision precision = precision::automatic;

    /// Solver parameters: stopping, and those of Newton's method, which is the `automatic` one here.
    solve::params solve = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (precision != precision::automatic && precision != precision::fp64 && precision != precision::mixed &&
            precision != precision::fp32)
            throw parameter_error("precision", "must be automatic, fp64, mixed or fp32");
        if (solve.method != solve::method::automatic && solve.method != solve::method::newton)
            throw parameter_error("solve.method", "must be automatic or newton");
        solve.validate();
        solve.require_newton_search();
    }
};

/// Deforms a volume, or a planar mesh, all z equal, with as little distortion as the energy asks for, so that pins are
/// met bit for bit and no element is inverted: one call of a session. Shapes with inverted elements are untangled
/// first.
///
/// The outcome is gave_up or infeasible, as in a map_report, where no certified shape was found, or pins could not be
/// brought to their targets; in the latter case the injective shape with the pins as far as they came is returned,
/// pins_held false. It is stopped where the limits ended the run before the pins reached their targets.
/// Throws mesh_error, parameter_error, constraint_error, device_error.
template <class Element>
session_result<Element> deform(queue& q, const mesh<Element>& m, const deform_params<Element>& params,
                               const run_limits& limits = {});

/// Deforms a surface in space as a thin shell, so that pins are met bit for bit and no triangle is collapsed: one call
/// of a session<hinge>. Outcomes as above; a start with collapsed triangles is gave_up.
///
///     const taut::thin_shell shell(surface);
///     auto pins = taut::constraints(shell.hinges()).pin(12, {0, 0, 1});
///     auto [x, report] = taut::deform(queue, shell, {.constraints = pins, .thickness = 0.01});
template <std::same_as<thin_shell> Shell>
session_result<hinge> deform(queue& q, const Shell& shell, const shell_params& params, const run_limits& limits = {});

/// Result of deform() with refinement: the deformation, and the refined mesh.
template <class Element>
struct refined_deformation
{
    session_result<Element> result; ///< deformation of the refined mesh
    mesh<Element> refined;          ///< the vertices of the mesh first, in their order
    impl::subdivision how;          ///< subdivision of the mesh; empty: no element was split
    std::vector<idx> cells;         ///< element of the mesh that contains each element of the refined mesh
    int rounds = 0;                 ///< rounds of splits
};

/// Deforms a mesh after splitting elements where it is proved that the pins admit no map without inverted elements:
/// inner edges between pinned vertices, say, where all corners of an element are pinned so that it is inverted. The
/// boundary is not split. `infeasible`: the proof holds for all splits inside the mesh; reason says which. Throws
/// parameter_error for params with targets, data of elements or owners, which refined elements do not have, and as
/// deform() does.
template <class Element>
refined_deformation<Element> deform(queue& q, const mesh<Element>& m, deform_params<Element> params,
                                    const run_limits& limits, const refine_params& refine);

/// Interpolation between two shapes of one mesh without inverted elements: of each element the rotation and the stretch
/// between the two shapes are interpolated separately, and the shape at t is the one whose elements differ least, by
/// the energy, from those that this gives. Rotations are consistent among neighbours, so that twists by a full turn or
/// more are interpolated as such.
template <class Element>
class interpolation
{
public:
    static constexpr int D = Element::dimension;
    using shape = std::vector<vec<D>>;

    /// from: the mesh, in its first shape. to: the second shape, one position per vertex. Of params, `targets`,
    /// `initial` and `regular` are overruled. limits: of each call of at().
    /// Throws mesh_error where the first shape has inverted or flat elements, parameter_error where the other one has.
    interpolation(const mesh<Element>& from, shape to, deform_params<Element> params = {}, run_limits limits = {})
        : from_(from),
          to_(checked(from, std::move(to))),
          params_(std::move(params)),
          limits_(std::move(limits)),
          path_(from, to_)
    {
        params_.regular = false;
    }

    /// Computes the shape at t: the two shapes, bit for bit, at 0 and 1. Without pins the middle of each component
    /// moves on a straight line. Throws parameter_error for t outside of [0, 1].
    session_result<Element> at(queue& q, double t) const
    {
        if (!(t >= 0 && t <= 1)) throw parameter_error("t", "must be in [0, 1]");
        auto params = params_;
        if (t > 0 && t < 1)
        {
            params.targets = path_.edges(t);
            params.initial = start(q, t);
            return deform(q, from_, params, limits_);
        }
        session_result<Element> end{t == 0 ? shape(from_.points().begin(), from_.points().end()) : to_, {}};
        end.report.outcome = outcome::valid;
        end.report.converged = end.report.pins_held = true;
        end.report.flips = certify<D>(from_.cells(), std::span<const vec<D>>(end.x));
        return end;
    }

private:
    static shape checked(const mesh<Element>& from, shape to)
    {
        if (to.size() != from.points().size())
            throw parameter_error("to", std::to_string(to.size()) + " positions for " +
                                            std::to_string(from.points().size()) + " vertices");
        static_cast<void>(impl::ideal_elements<Element>(from)); // none flat or inverted
        if (const auto flips = certify<D>(from.cells(), std::span<const vec<D>>(to)); !flips)
            throw parameter_error("to", "has " + impl::describe_defects<Element>(flips) + "; untangle it first");
        return to;
    }

    /// Injective shape near the initial guess at t.
    shape start(queue& q, double t) const
    {
        shape draft = path_.draft(t);
        if (certify<D>(from_.cells(), std::span<const vec<D>>(draft))) return draft;
        // The nearer end is pulled to it by springs.
        auto params = params_;
        shape end = t < 0.5 ? shape(from_.points().begin(), from_.points().end()) : to_;
        const auto turn = impl::fit_rigid_motion(std::span<const vec<D>>(end), std::span<const vec<D>>(draft));
        for (auto& p : end) p = turn(p);
        params.initial = std::move(end);
        params.targets = path_.edges(t);
        double size = 0;
        for (const auto& p : draft) size += glm::dot(p - turn.to, p - turn.to) / double(draft.size());
        params.constraints = constraints<Element>(from_);
        for (std::size_t v = 0; v < draft.size(); ++v)
            params.constraints.spring(static_cast<idx>(v), draft[v], 1000 / (size * double(draft.size())));
        auto drawn = deform(q, from_, params, limits_);
        return drawn ? std::move(drawn.x) : std::move(params.initial);
    }

    mesh<Element> from_;
    shape to_;
    deform_params<Element> params_;
    run_limits limits_;
    impl::shape_path<Element> path_;
};

} // namespace taut

#include <taut/rigid_motion.hpp>

#endif
#include <taut/impl/leave.inl>
