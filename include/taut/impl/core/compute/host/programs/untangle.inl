// SPDX-License-Identifier: MIT
// kernels/untangle.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

#define D 2
#define L 1
#define V 16
#define C 16
struct untangle_2 : work_item
{
#include <taut/impl/core/compute/host/kernels/untangle.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef D
#undef L
#undef V
#undef C

#define D 3
#define L 1
#define V 16
#define C 16
struct untangle_3 : work_item
{
#include <taut/impl/core/compute/host/kernels/untangle.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef D
#undef L
#undef V
#undef C

#include <taut/impl/core/compute/host/as_opencl_code.inl>

template <class P>
host_program untangle(int D)
{
    return {{{"D", D}, {"L", 1}, {"V", 16}},
            {entry<&P::untangle_elements>::make("untangle_elements", 1),
             entry<&P::untangle_decide>::make("untangle_decide", 1),
             entry<&P::untangle_move>::make("untangle_move", 64)}};
}

inline std::vector<host_program> untangle_programs()
{
    return {untangle<untangle_2>(2), untangle<untangle_3>(3)};
}
