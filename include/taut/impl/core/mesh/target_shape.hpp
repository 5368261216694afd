// SPDX-License-Identifier: MIT
#pragma once

#include <taut/types.hpp>

namespace taut::impl
{

/// Target shape and weight of an element.
template <int D>
struct target_shape
{
    mat<D> inverse;    ///< inverse of its ideal edge matrix
    double weight = 0; ///< weight; those of all elements sum to 1
};

} // namespace taut::impl
