// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include <taut/elements.hpp>

namespace taut
{

mat3 tetrahedron::ideal(const rest_corners& x)
{
    const vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const vec3 normal = glm::cross(a, b);
    const double length_a = length(a), double_area = length(normal);
    const vec3 u = a / length_a, w = normal / double_area;
    const vec3 v = glm::cross(w, u);
    return mat3(length_a, 0.0, 0.0,                          //
                glm::dot(b, u), double_area / length_a, 0.0, //
                glm::dot(c, u), glm::dot(c, v), glm::dot(c, w));
}

mat3 tetrahedron::frame(const rest_corners& x, const vec3& direction)
{
    const vec3 u = glm::normalize(x[1] - x[0]), w = glm::normalize(glm::cross(x[1] - x[0], x[2] - x[0]));
    const vec3 v = glm::cross(w, u), d = glm::normalize(direction);
    const vec3 first(glm::dot(d, u), glm::dot(d, v), glm::dot(d, w));
    const vec3 other = std::abs(first.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 second = glm::normalize(glm::cross(glm::cross(first, other), first));
    return mat3(first, second, glm::cross(first, second));
}

double tetrahedron::flatness(const mat3& W)
{
    const vec3 a = W[0], b = W[1], c = W[2], ab = b - a, ac = c - a, bc = c - b;
    const double longest = std::max({length(a), length(b), length(c), length(ab), length(ac), length(bc)});
    const double largest = std::max({length(glm::cross(a, b)), length(glm::cross(b, c)), length(glm::cross(c, a)),
                                     length(glm::cross(ab, ac))}); // twice the area of a face
    return W[0][0] * W[1][1] * W[2][2] / (largest * longest);
}

} // namespace taut
