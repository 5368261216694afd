// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/certify.hpp>

namespace taut
{

bool collapsed(const vec3& a, const vec3& b, const vec3& c)
{
    for (const vec3& p : {a, b, c})
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) return true;
    for (int k = 0; k < 3; ++k)
    {
        const auto flat = [i = (k + 1) % 3, j = (k + 2) % 3](const vec3& p) { return vec2(p[i], p[j]); };
        if (impl::orient2d(flat(a), flat(b), flat(c)) != 0) return false;
    }
    return true;
}

} // namespace taut
