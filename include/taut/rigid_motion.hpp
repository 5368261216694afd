// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_RIGID_MOTION_HPP
#define TAUT_RIGID_MOTION_HPP

#include <cmath>

#include <taut/types.hpp>

/// Rigid motions, by which sets of vertices are moved.
namespace taut
{

/// Rigid motion of the plane or of space: a rotation by an angle about an axis through `from`, which is moved to `to`:
/// {.to = t} translates by t, about(c, a) rotates.
template <int D>
struct rigid_motion
{
    vec<D> from{0.0}, to{0.0};
    vec3 axis{0, 0, 1}; ///< axis of length 1; in the plane the normal
    double angle = 0;   ///< radians; of a fit -pi to pi in the plane, 0 to pi in space

    /// Rotation about a point that stays where it is. axis: of any length but 0; in the plane there is no other.
    static rigid_motion about(const vec<D>& centre, double radians) requires(D == 2)
    {
        return {centre, centre, vec3(0, 0, 1), radians};
    }
    static rigid_motion about(const vec<D>& centre, double radians, const vec3& axis) requires(D == 3)
    {
        return {centre, centre, glm::normalize(axis), radians};
    }

    /// Image of a point under the fraction t of the motion, 0 to 1.
    vec<D> operator()(const vec<D>& p, double t = 1) const
    {
        return from + t * (to - from) + turned(p - from, t * angle);
    }

    /// v rotated about the axis, by Rodrigues' formula.
    vec<D> turned(const vec<D>& v, double by) const
    {
        const double c = std::cos(by), s = std::sin(by);
        if constexpr (D == 2)
            return vec2(c * v.x - s * v.y, s * v.x + c * v.y);
        else
            return c * v + s * glm::cross(axis, v) + (1 - c) * glm::dot(axis, v) * axis;
    }
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
