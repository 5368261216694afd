// SPDX-License-Identifier: MIT
#include "shared/interrupt.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <string>
#include <system_error>
#include <thread>

#include <poll.h>
#include <sys/time.h>
#include <unistd.h>

#include <taut/impl/io/atomic_file.hpp>

namespace taut::tools
{

namespace
{

/// State of the program for signal handlers.
enum class standing
{
    nothing, ///< to keep
    something,
    asked,  ///< to stop, with something to keep
    leaving ///< nobody but the watching thread has a say any more
};

std::atomic<standing> state{standing::nothing};
std::atomic<int> asked_by{SIGINT};

/// Never returns to a thread that still asks while the program is ended: what is done from here on is done for nobody.
standing present() noexcept
{
    standing now = state;
    for (; now == standing::leaving; now = state) ::pause();
    return now;
}

exit_code code_of(int signal) noexcept
{
    return signal == SIGTERM ? exit_code::terminated : exit_code::interrupted;
}

sigset_t watched() noexcept
{
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGALRM}) sigaddset(&set, signal);
    return set;
}

/// Ends the program without a look at what other threads are doing.
[[noreturn]] void leave(exit_code code, const std::string& why)
{
    const std::string bar_off = ::isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "";
    const std::string text = bar_off + "taut: error: " + why + '\n';
    pollfd out{STDERR_FILENO, POLLOUT, 0};
    // Where nobody reads, a message is not worth waiting for.
    if (::poll(&out, 1, 0) == 1) [[maybe_unused]]
        const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    io::impl::remove_temporaries();
    ::_exit(to_int(code));
}

void take(int signal)
{
    auto now = standing::nothing;
    const bool lossless = state.compare_exchange_strong(now, standing::leaving);
    if (signal == SIGALRM)
    {
        if (lossless) leave(exit_code::no_valid_map, "the time limit came before there was a map; nothing was written");
        return;
    }
    if (lossless) leave(code_of(signal), "interrupted; nothing was written");
    asked_by = signal;
    if (now == standing::something && state.compare_exchange_strong(now, standing::asked)) return;
    state = standing::leaving;
    leave(code_of(signal), "interrupted twice, ended at once");
}

[[noreturn]] void watch()
{
    const sigset_t set = watched();
    for (;;)
        if (int signal = 0; ::sigwait(&set, &signal) == 0) take(signal);
}

} // namespace

void watch_interrupts()
{
    const sigset_t set = watched();
    // A shell starts programs in the background with SIGINT ignored; whoever sends it means it.
    for (const int signal : {SIGINT, SIGTERM, SIGALRM}) std::signal(signal, SIG_DFL);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
    try
    {
        std::thread(watch).detach();
    }
    catch (const std::system_error&) // no thread to be had: signals do what they do to any program
    {
        ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    }
}

void limit_time(double seconds)
{
    constexpr double longest = 1e8; // beyond what timers are asked to do
    if (!(seconds < longest)) return;
    seconds = std::max(0.0, seconds);
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = std::max<suseconds_t>(1, static_cast<suseconds_t>((seconds - whole) * 1e6));
    ::setitimer(ITIMER_REAL, &timer, nullptr);
}

void keep(bool something)
{
    const auto wanted = something ? standing::something : standing::nothing;
    auto now = present();
    while (now == standing::nothing || now == standing::something)
        if (now == wanted || state.compare_exchange_weak(now, wanted)) return;
    present();
}

bool interrupted() noexcept
{
    return present() == standing::asked;
}

exit_code interruption() noexcept
{
    return code_of(asked_by);
}

} // namespace taut::tools
