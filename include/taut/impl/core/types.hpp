// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace taut
{

/// Index type of vertices, cells and edges: 32 bits, signed, 0-based; the same type on the host and on the device.
using idx = std::int32_t;

/// Column vector of D numbers.
template <int D, class T = double>
using vec = glm::vec<D, T>;

/// D by D matrix, column-major as in GLM: m[c][r].
template <int D, class T = double>
using mat = glm::mat<D, D, T>;

/// Point or vector of the plane.
using vec2 = vec<2>;

/// Point or vector of space.
using vec3 = vec<3>;

/// 2 by 2 matrix.
using mat2 = mat<2>;

/// 3 by 3 matrix.
using mat3 = mat<3>;

} // namespace taut
