// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <taut/impl/charts/paste/rbf_basis.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// A field of vectors in space that interpolates values at points (paper, eq. 27):
/// s(x) = sum_i weights[i] phi(|y - centres[i]|) + polynomial(y) with y = (x - origin) / unit. Where it is evaluated
/// many times, rbf_evaluator does so on a device.
struct rbf_field
{
    rbf_basis basis = rbf_basis::cubic;
    double radius = 1;         ///< of compact functions, in normalised lengths
    vec3 origin{0.0};          ///< what coordinates are taken from
    double unit = 1;           ///< and what is one length of them
    std::vector<vec3> centres; ///< in normalised coordinates, without duplicates
    std::vector<vec3> weights; ///< one per centre
    std::array<vec3, 4> polynomial{vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0)}; ///< constant, then of y.x, y.y and y.z

    vec3 operator()(const vec3& x) const
    {
        const vec3 y = (x - origin) / unit;
        vec3 sum = polynomial[0] + y.x * polynomial[1] + y.y * polynomial[2] + y.z * polynomial[3];
        for (std::size_t i = 0; i < centres.size(); ++i)
            sum += rbf_value(basis, glm::distance(y, centres[i]), radius) * weights[i];
        return sum;
    }
};

} // namespace taut::impl
