// SPDX-License-Identifier: MIT
// kernels/rbf.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

#define REAL float
#define REAL_IS_DOUBLE 0
namespace of_float
{
#include <taut/impl/core/compute/host/programs/real_rbf.inl>
} // namespace of_float
#undef REAL
#undef REAL_IS_DOUBLE

#define REAL double
#define REAL_IS_DOUBLE 1
namespace of_double
{
#include <taut/impl/core/compute/host/programs/real_rbf.inl>
} // namespace of_double
#undef REAL
#undef REAL_IS_DOUBLE

#include <taut/impl/core/compute/host/as_opencl_code.inl>

template <class P>
host_program rbf(const char* real, int phi)
{
    return {{{"REAL", real}, {"PHI", phi}}, {entry<&P::rbf_evaluate>::make("rbf_evaluate", 8)}};
}

inline std::vector<host_program> rbf_programs()
{
    return {rbf<of_float::rbf_0>("float", 0),
            rbf<of_float::rbf_1>("float", 1),
            rbf<of_float::rbf_2>("float", 2),
            rbf<of_float::rbf_3>("float", 3),
            rbf<of_float::rbf_4>("float", 4),
            rbf<of_double::rbf_0>("double", 0),
            rbf<of_double::rbf_1>("double", 1),
            rbf<of_double::rbf_2>("double", 2),
            rbf<of_double::rbf_3>("double", 3),
            rbf<of_double::rbf_4>("double", 4)};
}
