// SPDX-License-Identifier: MIT
#if defined(__x86_64__) && !defined(_WIN32) && !defined(__AVX2__) // Windows keeps stacks at 16 bytes
#define TAUT_HOST_AVX2 1
#endif

#include <taut/impl/core/compute/host/programs/bake.ipp>
#include <taut/impl/core/compute/host/programs/blocks.ipp>
#include <taut/impl/core/compute/host/programs/charts.ipp>
#include <taut/impl/core/compute/host/programs/feature_map.ipp>
#include <taut/impl/core/compute/host/programs/rbf.ipp>
#include <taut/impl/core/compute/host/programs/untangle.ipp>
#include <taut/impl/core/compute/host/programs/vectors.ipp>
