// SPDX-License-Identifier: MIT
// Fields of radial basis functions for one REAL.

#define PHI 0
struct rbf_0 : work_item
{
#include <taut/impl/core/compute/host/kernels/rbf.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef PHI

#define PHI 1
struct rbf_1 : work_item
{
#include <taut/impl/core/compute/host/kernels/rbf.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef PHI

#define PHI 2
struct rbf_2 : work_item
{
#include <taut/impl/core/compute/host/kernels/rbf.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef PHI

#define PHI 3
struct rbf_3 : work_item
{
#include <taut/impl/core/compute/host/kernels/rbf.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef PHI

#define PHI 4
struct rbf_4 : work_item
{
#include <taut/impl/core/compute/host/kernels/rbf.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef PHI

