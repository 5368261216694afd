// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/compute/kernels/blas.hpp>
#include <taut/impl/compute/kernels/gather.hpp>
#include <taut/impl/compute/kernels/reduce.hpp>
#include <taut/impl/compute/program/few_functions.hpp>
#include <taut/impl/compute/reduction_plan.hpp>
#include <taut/impl/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// Vector operations as one program: kernels/blas.cl, gather.cl and reduce.cl. Drivers read OpenCL's header at each
/// build, and PoCL does even where its cache holds the program, for some 50 ms.
inline const std::string& vector_program()
{
    static const std::string text = std::string(kernels::blas) + kernels::gather + kernels::reduce;
    return text;
}

/// Its build options for numbers of a type.
inline std::string vector_options(scalar_type real, const device& d, const reduction_plan& plan)
{
    return few_functions + ("-DREAL=" + std::string(spelling(real)) + " -DFP64=" + (d.has_fp64() ? "1" : "0") +
                            " -DL=" + std::to_string(plan.local) + " -DV=" + std::to_string(plan.width));
}

} // namespace taut::impl
