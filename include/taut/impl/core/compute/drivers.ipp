// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/compute/drivers.hpp>
#include <taut/impl/core/compute/host/commands.ipp>
#if TAUT_WITH_OPENCL
#include <taut/impl/core/compute/opencl/commands.ipp>
#include <taut/impl/core/compute/opencl/drivers.ipp>
#include <taut/impl/core/compute/opencl/library.ipp>
#include <taut/impl/core/compute/program/program_store.ipp>
#include <taut/impl/core/compute/program_cache.ipp>
#else
#include <taut/impl/core/compute/opencl/no_drivers.ipp>
#endif
