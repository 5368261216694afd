// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernels/blas.hpp>
#include <taut/impl/core/compute/kernels/gather.hpp>
#include <taut/impl/core/compute/kernels/reduce.hpp>
#include <taut/impl/core/compute/program/own_program.hpp>
#include <taut/impl/core/compute/reduction_plan.hpp>
#include <taut/impl/core/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// Vector operations as one program: kernels/blas.cl, gather.cl and reduce.cl, for numbers of a type. Drivers read
/// OpenCL's header at each build, and PoCL does even where its cache holds the program, for some 50 ms.
inline own_program vector_program(scalar_type real, const device& d, const reduction_plan& plan)
{
    static const std::string text = std::string(kernels::blas) + kernels::gather + kernels::reduce;
    return {
        .text = text,
        .host = host_vectors,
        .settings = {{"REAL", spelling(real)}, {"FP64", d.has_fp64() ? 1 : 0}, {"L", plan.local}, {"V", plan.width}},
        .real = real};
}

} // namespace taut::impl
