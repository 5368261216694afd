// SPDX-License-Identifier: MIT
// Programs on block-sparse matrices for one REAL, in the forms that CPUs have.

#define D 2
#define K 3
#define C 16
#define V 16
#define TEAM 1
#define GROUP 64
#define SHARE 16
#define ITEMS 16
#define EPSILON (REAL_IS_DOUBLE ? REAL(1e-12) : REAL(2e-6f))
struct blocks_2_3 : work_item
{
#include <taut/impl/core/compute/host/kernels/block_sparse.inl>
#include <taut/impl/core/compute/host/kernels/block_setup.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef D
#undef K
#undef C
#undef V
#undef GROUP
#undef SHARE
#undef ITEMS
#undef EPSILON

#define D 3
#define K 3
#define C 16
#define V 16
#define TEAM 1
#define GROUP 64
#define SHARE 16
#define ITEMS 16
#define EPSILON (REAL_IS_DOUBLE ? REAL(1e-12) : REAL(2e-6f))
struct blocks_3_3 : work_item
{
#include <taut/impl/core/compute/host/kernels/block_sparse.inl>
#include <taut/impl/core/compute/host/kernels/block_setup.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef D
#undef K
#undef C
#undef V
#undef GROUP
#undef SHARE
#undef ITEMS
#undef EPSILON

#define D 3
#define K 4
#define C 16
#define V 16
#define TEAM 1
#define GROUP 32
#define SHARE 16
#define ITEMS 16
#define EPSILON (REAL_IS_DOUBLE ? REAL(1e-12) : REAL(2e-6f))
struct blocks_3_4 : work_item
{
#include <taut/impl/core/compute/host/kernels/block_sparse.inl>
#include <taut/impl/core/compute/host/kernels/block_setup.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef D
#undef K
#undef C
#undef V
#undef GROUP
#undef SHARE
#undef ITEMS
#undef EPSILON

