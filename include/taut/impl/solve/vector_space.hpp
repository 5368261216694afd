// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <span>

namespace taut::solve
{

/// Vector space of a solver: eight lines of linear algebra and nothing of memory, devices or meshes. Vectors are opaque
/// and movable; scalars are double on the host whatever the vectors hold.
///
/// On a device each `dot` and `multi_dot` makes the host wait for the queue (tens of microseconds, as much as a small
/// kernel), while `copy`, `axpby` and `linear_combination` are only enqueued. The algorithms therefore ask for many
/// products in one `multi_dot`.
///
/// | call                              | meaning                                                                  |
/// |-----------------------------------|--------------------------------------------------------------------------|
/// | `make()`                          | a zero vector                                                            |
/// | `copy(x, y)`                      | y = x                                                                    |
/// | `axpby(a, x, b, y)`               | y = a x + b y; b == 0 never reads y                                      |
/// | `dot(x, y)`                       | x'y                                                                      |
/// | `multi_dot(left, right, out)`     | out[i * right.size() + j] = left[i]'right[j]                             |
/// | `linear_combination(a, x, out)`   | out = sum of a[i] x[i]; out may be x[0], and no other of them            |
template <class S>
concept vector_space = std::movable<typename S::vector> &&
    requires(S& space, const typename S::vector& x, typename S::vector& y, double a, std::span<const double> many,
             std::span<const typename S::vector* const> vectors, std::span<double> out)
{
    {
        space.make()
        } -> std::same_as<typename S::vector>;
    space.copy(x, y);
    space.axpby(a, x, a, y);
    {
        space.dot(x, x)
        } -> std::convertible_to<double>;
    space.multi_dot(vectors, vectors, out);
    space.linear_combination(many, vectors, y);
};

} // namespace taut::solve
