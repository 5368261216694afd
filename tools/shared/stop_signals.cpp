// SPDX-License-Identifier: MIT
#include "shared/stop_signals.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <system_error>
#include <thread>

#include <poll.h>
#include <sys/time.h>
#include <unistd.h>

namespace taut::tools
{

namespace
{

stop_signal known(int signal) noexcept
{
    if (signal == SIGALRM) return stop_signal::alarm;
    return signal == SIGINT ? stop_signal::interrupt : stop_signal::terminate;
}

bool is_ignored(int signal) noexcept
{
    struct sigaction now = {};
    return ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

[[noreturn]] void watch(void (*take)(stop_signal), sigset_t set)
{
    for (;;)
        if (int signal = 0; ::sigwait(&set, &signal) == 0) take(known(signal));
}

} // namespace

void watch_signals(void (*take)(stop_signal))
{
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGALRM, SIGHUP, SIGQUIT})
    {
        if (signal == SIGHUP && is_ignored(signal)) continue; // by nohup: the run outlives its terminal
        // A shell starts programs in the background with SIGINT ignored; whoever sends it means it.
        std::signal(signal, SIG_DFL);
        sigaddset(&set, signal);
    }
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
    try
    {
        std::thread(watch, take, set).detach();
    }
    catch (const std::system_error&) // no thread to be had: signals do what they do to any program
    {
        ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    }
}

void set_alarm(double seconds)
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

void wait_for_signals() noexcept
{
    ::pause();
}

void tell_if_read(const std::string& text) noexcept
{
    pollfd out{STDERR_FILENO, POLLOUT, 0};
    // Where nobody reads, a message is not worth waiting for.
    if (::poll(&out, 1, 0) != 1) return;
    const char* bar_off = "\r\x1b[K";
    if (::isatty(STDERR_FILENO) == 1) [[maybe_unused]]
        const auto cleared = ::write(STDERR_FILENO, bar_off, 4);
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

} // namespace taut::tools
