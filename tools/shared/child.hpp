// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include <taut/files.hpp>

namespace taut::tools
{

struct limits
{
    double seconds = std::numeric_limits<double>::infinity();
    std::uint64_t memory = std::numeric_limits<std::uint64_t>::max(); ///< bytes that are resident
    double grace = 5; ///< seconds from being asked to end until it is made to
};

/// NAME=VALUE of this process.
std::vector<std::string> environment();

/// End of a child process.
struct child_end
{
    enum cause
    {
        itself,
        time_limit,
        memory_limit,
        asked ///< by stop()
    };
    cause by = itself;
    int code = 0;   ///< as shells have it: 128 + the signal that ended it
    int signal = 0; ///< or none
    double seconds = 0, cpu_seconds = 0;
    std::uint64_t peak_memory = 0;   ///< bytes
    std::string printed, complaints; ///< the last 64 KiB of standard output and error
};

/// This program as a child process, in a process group of its own. Over its time it is asked to
/// end (SIGTERM), so that it keeps what it has, and after the grace it is killed; over its memory it is killed at once.
/// It does not outlive this process, whatever ends that.
class child
{
public:
    /// environment: NAME=VALUE. input: what it reads. Throws std::system_error if no process can be made.
    child(const std::vector<std::string>& args, const std::vector<std::string>& environment, const limits& bounds,
          const std::string& input = {});
    ~child();
    child(const child&) = delete;
    child& operator=(const child&) = delete;

    /// Descriptors to wait for: output to read, or its end.
    std::array<pollfd, 3> news() const noexcept;

    /// Reads what it has said, and holds it to its limits. To be called every few hundredths of a second.
    /// Returns how it ended, once.
    std::optional<child_end> look();

    /// Asks it to end, and kills it after the grace.
    void stop(int signal) noexcept;

private:
    using clock = std::chrono::steady_clock;

    double seconds() const noexcept { return std::chrono::duration<double>(clock::now() - start_).count(); }
    void ask(int signal, child_end::cause why) noexcept;
    void kill_all() const noexcept;
    std::uint64_t resident() const noexcept;
    void drain(std::size_t stream);

    limits bounds_;
    clock::time_point start_ = clock::now();
    pid_t process_ = 0;                           ///< 0 once its end is known
    std::array<io::impl::descriptor, 2> streams_; ///< closed once nothing more can come
    io::impl::descriptor over_;                   ///< readable once it has ended; none on older systems
    std::array<std::string, 2> said_;
    child_end::cause by_ = child_end::itself;
    double killed_at_ = std::numeric_limits<double>::infinity(); ///< seconds
};

} // namespace taut::tools
