// SPDX-License-Identifier: MIT
// kernels/block_sparse.cl and block_setup.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

#define REAL float
#define REAL_IS_DOUBLE 0
namespace of_float
{
#include <taut/impl/core/compute/host/programs/real_blocks.inl>
} // namespace of_float
#undef REAL
#undef REAL_IS_DOUBLE

#define REAL double
#define REAL_IS_DOUBLE 1
namespace of_double
{
#include <taut/impl/core/compute/host/programs/real_blocks.inl>
} // namespace of_double
#undef REAL
#undef REAL_IS_DOUBLE

#include <taut/impl/core/compute/host/as_opencl_code.inl>

template <class P>
host_program blocks(const char* real, int D, int K)
{
    return {{{"REAL", real}, {"D", D}, {"K", K}, {"V", 16}},
            {entry<&P::product>::make("product", 32), entry<&P::smooth>::make("smooth", 32),
             entry<&P::jacobi>::make("jacobi", 64), entry<&P::restrict_residual>::make("restrict_residual", 32),
             entry<&P::prolong>::make("prolong", 64), entry<&P::dense>::make("dense", 8),
             entry<&P::small_cycle>::make("small_cycle", 1), entry<&P::invert_blocks>::make("invert_blocks", 32),
             entry<&P::assemble>::make("assemble", 8), entry<&P::galerkin>::make("galerkin", 1),
             entry<&P::invert_dense>::make("invert_dense", 1)}};
}

inline std::vector<host_program> blocks_programs()
{
    return {blocks<of_float::blocks_2_3>("float", 2, 3),   blocks<of_float::blocks_3_3>("float", 3, 3),
            blocks<of_float::blocks_3_4>("float", 3, 4),   blocks<of_double::blocks_2_3>("double", 2, 3),
            blocks<of_double::blocks_3_3>("double", 3, 3), blocks<of_double::blocks_3_4>("double", 3, 4)};
}
