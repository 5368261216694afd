// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace taut::tools::mpi
{

/// What this process has sent so far by MPI, the libraries' share included.
struct traffic
{
    std::uint64_t messages = 0;   ///< point to point
    std::uint64_t bytes = 0;      ///< in them
    std::uint64_t reductions = 0; ///< Allreduce
    std::uint64_t exchanges = 0;  ///< other collective calls
};

traffic sent_so_far() noexcept;

} // namespace taut::tools::mpi
