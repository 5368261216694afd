// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/exact/certify.hpp>
#include <taut/impl/map/deform.hpp>
#include <taut/impl/measure/describe_defects.hpp>
#include <taut/impl/start/shape_path.hpp>

namespace taut
{

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
