// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/exact/predicates.hpp>

namespace taut::impl
{

orientation exact_orient(const vec2& a, const vec2& b, const vec2& c)
{
    if (a == b || b == c || c == a) return {0, 0.0}; // often, and the sum takes a hundred times as long
    exact_sum<2> sum;
    const auto cross = [&sum](const vec2& p, const vec2& q)
    {
        sum.add(false, {p.x, q.y});
        sum.add(true, {p.y, q.x});
    };
    cross(b, c);
    cross(c, a);
    cross(a, b);
    const int sign = sum.sign();
    return {sign, sign * sum.magnitude()};
}

orientation exact_orient(const vec3& a, const vec3& b, const vec3& c, const vec3& d)
{
    exact_sum<3> sum;
    const auto triple = [&sum](bool negative, const vec3& p, const vec3& q, const vec3& r)
    {
        for (int x = 0; x < 3; ++x)
        {
            const int y = (x + 1) % 3;
            const int z = (x + 2) % 3;
            sum.add(negative, {p[x], q[y], r[z]});
            sum.add(!negative, {p[x], q[z], r[y]});
        }
    };
    triple(false, b, c, d);
    triple(true, a, c, d);
    triple(false, a, b, d);
    triple(true, a, b, c);
    const int sign = sum.sign();
    return {sign, sign * sum.magnitude()};
}

} // namespace taut::impl
