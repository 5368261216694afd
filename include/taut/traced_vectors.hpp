// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_TRACED_VECTORS_HPP
#define TAUT_TRACED_VECTORS_HPP

#include <glm/glm.hpp>

#include <taut/symbolic.hpp>

/// Completion of GLM's templates for traced scalars. Its vectors, matrices, products, determinant(), inverse(),
/// transpose(), dot(), cross(), length() and normalize() work as they are.
///
/// GLM deduces one scalar type from both operands, so a host factor needs operators of its own; and its component-wise
/// functions call std:: ones. Ours are more specialised, and win.
namespace taut::impl
{

template <class A>
concept host_scalar = std::floating_point<A> || std::integral<A>;

/// f of each component.
template <glm::length_t L, class T, glm::qualifier Q, class F>
auto map(const glm::vec<L, T, Q>& v, F f)
{
    glm::vec<L, decltype(f(v[0])), Q> result;
    for (glm::length_t k = 0; k < L; ++k) result[k] = f(v[k]);
    return result;
}

} // namespace taut::impl

namespace taut
{

template <glm::length_t L, class T, glm::qualifier Q, impl::host_scalar A>
glm::vec<L, sym<T>, Q> operator*(const glm::vec<L, sym<T>, Q>& v, A a)
{
    return v * sym<T>(a);
}

template <glm::length_t L, class T, glm::qualifier Q, impl::host_scalar A>
glm::vec<L, sym<T>, Q> operator*(A a, const glm::vec<L, sym<T>, Q>& v)
{
    return sym<T>(a) * v;
}

template <glm::length_t L, class T, glm::qualifier Q, impl::host_scalar A>
glm::vec<L, sym<T>, Q> operator/(const glm::vec<L, sym<T>, Q>& v, A a)
{
    return v / sym<T>(a);
}

template <glm::length_t C, glm::length_t R, class T, glm::qualifier Q, impl::host_scalar A>
glm::mat<C, R, sym<T>, Q> operator*(const glm::mat<C, R, sym<T>, Q>& m, A a)
{
    return m * sym<T>(a);
}

template <glm::length_t C, glm::length_t R, class T, glm::qualifier Q, impl::host_scalar A>
glm::mat<C, R, sym<T>, Q> operator*(A a, const glm::mat<C, R, sym<T>, Q>& m)
{
    return sym<T>(a) * m;
}

template <glm::length_t C, glm::length_t R, class T, glm::qualifier Q, impl::host_scalar A>
glm::mat<C, R, sym<T>, Q> operator/(const glm::mat<C, R, sym<T>, Q>& m, A a)
{
    return m / sym<T>(a);
}

/// Square root of each component of a traced vector.
template <glm::length_t L, class T, glm::qualifier Q>
glm::vec<L, sym<T>, Q> sqrt(const glm::vec<L, sym<T>, Q>& v)
{
    return impl::map(v, [](sym<T> x) { return sqrt(x); });
}

/// Absolute value of each component of a traced vector.
template <glm::length_t L, class T, glm::qualifier Q>
glm::vec<L, sym<T>, Q> abs(const glm::vec<L, sym<T>, Q>& v)
{
    return impl::map(v, [](sym<T> x) { return abs(x); });
}

/// Componentwise minimum of two traced vectors.
template <glm::length_t L, class T, glm::qualifier Q>
glm::vec<L, sym<T>, Q> min(const glm::vec<L, sym<T>, Q>& v, const glm::vec<L, sym<T>, Q>& w)
{
    glm::vec<L, sym<T>, Q> result;
    for (glm::length_t k = 0; k < L; ++k) result[k] = min(v[k], w[k]);
    return result;
}

/// Componentwise maximum of two traced vectors.
template <glm::length_t L, class T, glm::qualifier Q>
glm::vec<L, sym<T>, Q> max(const glm::vec<L, sym<T>, Q>& v, const glm::vec<L, sym<T>, Q>& w)
{
    glm::vec<L, sym<T>, Q> result;
    for (glm::length_t k = 0; k < L; ++k) result[k] = max(v[k], w[k]);
    return result;
}

/// Precision changes component by component.
template <impl::traceable To, glm::length_t L, class T, glm::qualifier Q>
glm::vec<L, sym<To>, Q> cast(const glm::vec<L, sym<T>, Q>& v)
{
    return impl::map(v, [](sym<T> x) { return cast<To>(x); });
}

template <impl::traceable To, glm::length_t C, glm::length_t R, class T, glm::qualifier Q>
glm::mat<C, R, sym<To>, Q> cast(const glm::mat<C, R, sym<T>, Q>& m)
{
    glm::mat<C, R, sym<To>, Q> result;
    for (glm::length_t c = 0; c < C; ++c) result[c] = cast<To>(m[c]);
    return result;
}

} // namespace taut

#endif
#include <taut/impl/leave.inl>
