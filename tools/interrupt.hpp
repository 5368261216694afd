// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace taut::tools
{

namespace detail
{
/// A signal handler can reach nothing but globals, hence this one. Lock-free, as handlers demand.
inline std::atomic<bool> interrupt_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free);
} // namespace detail

/// While it lives, the first Ctrl-C (SIGINT) only sets a flag, which observers ask between iterations; the second one
/// ends the program as if this class did not exist. One at a time. The previous handling is restored at the end.
/// Errors: std::system_error if the handler cannot be installed.
class interrupt_guard
{
public:
    interrupt_guard()
    {
        detail::interrupt_flag = false;
        struct sigaction action = {};
        action.sa_handler = [](int) { detail::interrupt_flag.store(true, std::memory_order_relaxed); };
        sigemptyset(&action.sa_mask);
        // RESETHAND: the default, death, is back in force for the second signal. RESTART: no read or write fails.
        action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
        if (sigaction(SIGINT, &action, &previous_) != 0)
            throw std::system_error(errno, std::generic_category(), "SIGINT cannot be handled");
    }

    ~interrupt_guard() { sigaction(SIGINT, &previous_, nullptr); }

    interrupt_guard(const interrupt_guard&) = delete;
    interrupt_guard& operator=(const interrupt_guard&) = delete;

    /// True from the first Ctrl-C on. Cheap, callable from any thread.
    bool requested() const noexcept { return detail::interrupt_flag.load(std::memory_order_relaxed); }

private:
    struct sigaction previous_ = {};
};

} // namespace taut::tools
