// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/core/compute/host/opencl_c.hpp>
#include <taut/impl/core/compute/host/programs.hpp>

#include <taut/impl/core/compute/host/baseline_begin.inl>
#include <taut/impl/core/compute/host/programs/charts.inl>

#include <taut/impl/core/compute/host/baseline_end.inl>

#if TAUT_HOST_AVX2
#include <taut/impl/core/compute/host/avx2_begin.inl>
#include <taut/impl/core/compute/host/programs/charts.inl>

#include <taut/impl/core/compute/host/avx2_end.inl>
#endif

namespace taut::impl
{

const std::vector<host_program>& host_charts()
{
    static const std::vector<host_program> all = TAUT_HOST_SET(charts_programs)();
    return all;
}

} // namespace taut::impl
