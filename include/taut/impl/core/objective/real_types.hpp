// SPDX-License-Identifier: MIT
#pragma once

#include <taut/errors.hpp>
#include <taut/impl/core/symbolic/scalar_type.hpp>
#include <taut/options.hpp>

namespace taut::impl
{

/// Scalar types of kernels by precision: f32 or f64 for each of two kinds of numbers.
struct real_types
{
    scalar_type position = scalar_type::f64; ///< positions, and what is formed from their differences
    scalar_type vector = scalar_type::f64;   ///< directions, gradients, energies, matrices, what is constant in a mesh

    friend bool operator==(const real_types&, const real_types&) = default;
};

/// Throws parameter_error for `automatic`, which is a choice and no precision.
inline real_types types_of(precision p)
{
    switch (p)
    {
    case precision::fp64:
        return {};
    case precision::mixed:
        return {.vector = scalar_type::f32};
    case precision::fp32:
        return {.position = scalar_type::f32, .vector = scalar_type::f32};
    case precision::automatic:
        break;
    }
    throw parameter_error("precision", "must be fp64, mixed or fp32");
}

} // namespace taut::impl
