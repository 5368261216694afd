// SPDX-License-Identifier: MIT
// kernels/charts.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

#define REAL float
#define REAL_IS_DOUBLE 0
namespace of_float
{
#include <taut/impl/core/compute/host/programs/real_charts.inl>
} // namespace of_float
#undef REAL
#undef REAL_IS_DOUBLE

#define REAL double
#define REAL_IS_DOUBLE 1
namespace of_double
{
#include <taut/impl/core/compute/host/programs/real_charts.inl>
} // namespace of_double
#undef REAL
#undef REAL_IS_DOUBLE

#include <taut/impl/core/compute/host/as_opencl_code.inl>

template <class P>
host_program charts(const char* real)
{
    return {{{"REAL", real}, {"TEAM", 1}}, {entry<&P::chart_newton>::make("chart_newton", 1)}};
}

inline std::vector<host_program> charts_programs()
{
    return {charts<of_float::charts>("float"), charts<of_double::charts>("double")};
}
