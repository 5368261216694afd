// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <type_traits>

#include <taut/compute/detail/kernels/blas.hpp>
#include <taut/compute/detail/kernels/gather.hpp>
#include <taut/compute/detail/kernels/reduce.hpp>
#include <taut/compute/reduction_plan.hpp>

namespace taut::detail
{

/// What vectors need, as one program: kernels/blas.cl, gather.cl and reduce.cl. Drivers read OpenCL's header at each
/// build, and PoCL does even where its cache holds the program, for some 50 ms.
inline const std::string& vector_program()
{
    static const std::string text = std::string(kernels::blas) + kernels::gather + kernels::reduce;
    return text;
}

/// Its build options for numbers of type T.
template <class T>
std::string vector_options(const device& d, const reduction_plan& plan)
{
    return std::string("-DREAL=") + (std::is_same_v<T, double> ? "double" : "float") +
           " -DFP64=" + (d.has_fp64() ? "1" : "0") + " -DL=" + std::to_string(plan.local) +
           " -DV=" + std::to_string(plan.width);
}

} // namespace taut::detail
