// SPDX-License-Identifier: MIT
#include "shared/peak_memory.hpp"

#if defined(_WIN32)
#include <windows.h>

#include <psapi.h>
#else
#include <sys/resource.h>
#endif

namespace taut::tools
{

std::uint64_t peak_memory() noexcept
{
#if defined(_WIN32)
    PROCESS_MEMORY_COUNTERS used{};
    return ::K32GetProcessMemoryInfo(::GetCurrentProcess(), &used, sizeof(used)) ? used.PeakWorkingSetSize : 0;
#else
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux counts KiB
#endif
}

} // namespace taut::tools
