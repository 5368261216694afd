// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// A parameter of a kernel, as its OpenCL C says.
struct parameter
{
    std::string name;
    std::string type; ///< float, double, int, ...; of the elements behind a pointer
    bool is_memory = false;
};

/// One declaration, as in `__global const REAL* restrict x`.
parameter parse_parameter(std::string_view text, scalar_type real);

/// The parameters of `__kernel void name(...)` in a source. Empty where a macro makes the kernel.
std::vector<parameter> signature_of(std::string_view source, std::string_view name, scalar_type real);

} // namespace taut::impl
