// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include <malloc.h>
#include <sys/resource.h>

namespace bench
{

/// The peak of this process' resident memory during one piece of work. Linux resets its record on request, so that
/// each of several solvers gets its own peak; where it does not, the peak is that of the process so far.
class peak_memory
{
public:
    peak_memory()
    {
        malloc_trim(0); // what an earlier run left to the allocator is not ours
        std::ofstream("/proc/self/clear_refs") << 5;
        before_ = field("VmRSS:");
    }

    /// Resident bytes when the work began: the program, its libraries and what it keeps.
    std::size_t before() const { return before_; }

    std::size_t bytes() const
    {
        if (const auto peak = field("VmHWM:")) return peak;
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    }

private:
    static std::size_t field(const std::string& name)
    {
        std::ifstream status("/proc/self/status");
        for (std::string word; status >> word;)
            if (word == name && status >> word) return std::stoull(word) * 1024;
        return 0;
    }

    std::size_t before_ = 0;
};

} // namespace bench
