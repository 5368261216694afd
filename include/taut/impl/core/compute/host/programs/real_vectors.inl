// SPDX-License-Identifier: MIT
// Vector operations for one REAL, in the forms that CPUs have.

#define FP64 1
#define L 1
#define V 8
struct vectors : work_item
{
#include <taut/impl/core/compute/host/kernels/blas.inl>
#include <taut/impl/core/compute/host/kernels/gather.inl>
#include <taut/impl/core/compute/host/kernels/reduce.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef FP64
#undef L
#undef V

