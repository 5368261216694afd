// SPDX-License-Identifier: MIT
// kernels/bake.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

#define CHANNELS 1
struct bake_1 : work_item
{
#include <taut/impl/core/compute/host/kernels/bake.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef CHANNELS

#define CHANNELS 2
struct bake_2 : work_item
{
#include <taut/impl/core/compute/host/kernels/bake.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef CHANNELS

#define CHANNELS 3
struct bake_3 : work_item
{
#include <taut/impl/core/compute/host/kernels/bake.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef CHANNELS

#define CHANNELS 4
struct bake_4 : work_item
{
#include <taut/impl/core/compute/host/kernels/bake.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef CHANNELS

#include <taut/impl/core/compute/host/as_opencl_code.inl>

template <class P>
host_program bake(int channels)
{
    return {{{"CHANNELS", channels}}, {entry<&P::bake_texels>::make("bake_texels", 64)}};
}

inline std::vector<host_program> bake_programs()
{
    return {bake<bake_1>(1), bake<bake_2>(2), bake<bake_3>(3), bake<bake_4>(4)};
}
