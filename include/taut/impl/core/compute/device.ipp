// SPDX-License-Identifier: MIT
#pragma once

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

#include <cstddef>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>

#include <taut/device.hpp>
#include <taut/impl/core/compute/drivers.hpp>
#include <taut/impl/core/core/crew.hpp>
#include <taut/version.hpp>

namespace taut::impl
{

/// Bytes of memory of this machine; where nobody says, as many as there are addresses.
inline std::uint64_t host_memory()
{
#ifdef _SC_PHYS_PAGES
    const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
    if (pages > 0 && size > 0) return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size);
#endif
    return std::numeric_limits<std::size_t>::max() / 2;
}

} // namespace taut::impl

namespace taut
{

device::device(cl_device_id id) : facts_(impl::opencl_facts(id)) {}

device device::host()
{
    const std::size_t threads = impl::threads_at_once();
    const std::uint64_t memory = impl::host_memory();
    return device({.name = "host, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads"),
                   .vendor = "taut",
                   .driver_version = TAUT_VERSION_STRING,
                   .platform = "taut",
                   .type = device::facts::kind::cpu,
                   .has_fp64 = true,
                   .available = true,
                   .has_compiler = true,
                   .compute_units = threads,
                   .max_group = 4096,
                   .global_memory = memory,
                   .max_allocation = memory});
}

std::ostream& operator<<(std::ostream& out, const device& d)
{
    if (d.is_host()) return out << d.name() << (d.has_fp64() ? "" : ", no fp64");
    return out << d.name() << " ("
               << (d.is_gpu()   ? "GPU"
                   : d.is_cpu() ? "CPU"
                                : "accelerator")
               << ", " << d.platform() << ", driver " << d.driver_version() << (d.has_fp64() ? "" : ", no fp64") << ')';
}

} // namespace taut
