// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/device.hpp>

/// The oddities of platforms, by name. Code and tests ask these predicates instead of hiding workarounds.
///
/// PoCL's, which all of our code respects and nothing asks for:
/// - 3.1 gives wrong results for barriers inside loops (a min/max tree over two local arrays; Oclgrind runs it right)
/// and
///   compiles several trees in one kernel in exponential time. Our kernels hold at most one barrier outside of loops;
///   the exceptions with TEAM > 1 are invert_dense of block_setup.cl, which comes out right there (tests compare it),
///   and charts.cl, which does not: its form for GPUs is tested under Oclgrind.
/// - It reserves memory when a buffer is first touched, so an allocation beyond the device's limits "succeeds"; buffers
///   check the limits themselves.
/// - It emits scalar code around float2/double2 and around interleaved stores: kernels use scalar loads and stride-1
///   structure-of-arrays stores.
/// - It compiles a kernel once more for every local size: the library keeps to a few.
///
/// NVIDIA's (580.159, H100):
/// - A kernel with much private memory an item, as the form for CPUs of galerkin, is refused at its launch, as "out of
///   host memory" (-6): the driver reserves it for every item that the device can run at once.
/// - A launch takes 6 us of the host, a wait 12, a number read back 18: many small launches bind, not the device.
namespace taut::impl::quirks
{

/// PoCL, the portable CPU implementation: work-items are loops on CPU threads.
inline bool is_pocl(const std::string& platform)
{
    return platform == "Portable Computing Language";
}
inline bool is_pocl(const device& d)
{
    return is_pocl(d.platform());
}

/// The host device runs recorded kernels and taut's own, and has no compiler for OpenCL C of others.
inline bool compiles_no_text(const device& d)
{
    return d.is_host();
}

/// PoCL reads OpenCL's header of all functions, 900 kB, at each build, also where its cache holds the program: 80 ms,
/// or 20 of a cached one. Clang's guard of it keeps it out.
inline bool reads_long_header(const device& d)
{
    return is_pocl(d);
}

/// Intel's runtime for CPUs compiles each program in each process, some seconds in all: taut keeps them. PoCL and
/// NVIDIA keep them themselves.
inline bool keeps_no_programs(const device& d)
{
    return d.platform() == "Intel(R) OpenCL" && d.is_cpu();
}

/// Oclgrind, the checking simulator: slow, one item at a time, so tests shrink their sizes.
inline bool is_oclgrind(const device& d)
{
    return d.platform() == "Oclgrind";
}

/// A CPU runs one long serial loop per item far faster than a local-memory tree or a grid-stride loop (measured: dot of
/// a million doubles 0.24 ms against 3.9 ms and 2.0 ms; a grid-stride triad 31 ms against 0.38 ms).
inline bool wants_serial_items(const device& d)
{
    return d.is_cpu();
}

} // namespace taut::impl::quirks
