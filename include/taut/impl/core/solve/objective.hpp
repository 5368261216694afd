// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

namespace taut::solve::impl
{

/// Vector space type of an objective, without the reference but with a const of its own.
template <class O>
using space_of = std::remove_reference_t<decltype(std::declval<O&>().space())>;

/// Vector type of an objective, for gradients and directions.
template <class O>
using vector_of = typename space_of<O>::vector;

} // namespace taut::solve::impl
