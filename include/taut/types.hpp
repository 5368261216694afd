// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_TYPES_HPP
#define TAUT_TYPES_HPP

#include <concepts>
#include <cstdint>

#include <glm/glm.hpp>

/// Numbers, vectors and matrices that all headers share.
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

/// Types of numbers on a device, where precision is a value: f32 and f64 are float and double, i32 is idx. Comparisons
/// of traced values are boolean, and never lie in memory.
enum class scalar_type : std::uint8_t
{
    f32,
    f64,
    i32,
    boolean
};

/// Squared Frobenius norm |M|_F^2, the sum of the squares of all entries. T may be a traced scalar.
template <int D, class T>
T norm2(const glm::mat<D, D, T>& m)
{
    T sum = glm::dot(m[0], m[0]);
    for (int c = 1; c < D; ++c) sum = sum + glm::dot(m[c], m[c]);
    return sum;
}

/// Chooses one of two plain numbers, condition ? a : b, so that a template over double and a traced scalar can write
/// `select(cond, a, b)` for both; the traced overload is found by its arguments.
template <std::floating_point T>
constexpr T select(bool condition, T a, T b)
{
    return condition ? a : b;
}

} // namespace taut

#endif
#include <taut/impl/leave.inl>
