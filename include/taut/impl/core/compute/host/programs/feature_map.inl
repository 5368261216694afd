// SPDX-License-Identifier: MIT
// kernels/feature_map.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

struct feature_map_kernels : work_item
{
#include <taut/impl/core/compute/host/kernels/feature_map.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>

#include <taut/impl/core/compute/host/as_opencl_code.inl>

inline std::vector<host_program> feature_map_programs()
{
    using P = feature_map_kernels;
    return {{{},
             {entry<&P::map_cover>::make("map_cover", 64), entry<&P::map_continue>::make("map_continue", 256),
              entry<&P::map_sample>::make("map_sample", 256), entry<&P::map_roughness>::make("map_roughness", 64)}}};
}
