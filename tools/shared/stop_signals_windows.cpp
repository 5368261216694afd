// SPDX-License-Identifier: MIT
#include "shared/stop_signals.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <system_error>
#include <thread>

#include <io.h>
#include <windows.h>

namespace taut::tools
{

namespace
{

std::atomic<void (*)(stop_signal)> taker{nullptr};

/// Called by Windows, in a thread that it makes for that. A window that is closed ends the process when this returns,
/// or after some seconds.
BOOL WINAPI handle(DWORD event)
{
    const bool asked = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
    taker.load()(asked ? stop_signal::interrupt : stop_signal::terminate);
    if (!asked) ::Sleep(INFINITE);
    return TRUE;
}

} // namespace

void watch_signals(void (*take)(stop_signal))
{
    taker = take;
    ::SetConsoleCtrlHandler(nullptr, FALSE); // a parent may have ignored Ctrl-C; whoever sends it means it
    ::SetConsoleCtrlHandler(&handle, TRUE);
}

void set_alarm(double seconds)
{
    constexpr double longest = 1e8; // beyond what timers are asked to do
    if (!(seconds < longest)) return;
    try
    {
        std::thread(
            [pause = std::chrono::duration<double>(std::max(0.0, seconds))]
            {
                std::this_thread::sleep_for(pause);
                taker.load()(stop_signal::alarm);
            })
            .detach();
    }
    catch (const std::system_error&) // no thread to be had: the solver sees to its time by itself
    {
    }
}

void wait_for_signals() noexcept
{
    ::Sleep(100);
}

void tell_if_read(const std::string& text) noexcept
{
    const std::string whole = (::_isatty(2) != 0 ? "\r\x1b[K" : "") + text;
    ::_write(2, whole.data(), static_cast<unsigned>(whole.size()));
}

} // namespace taut::tools
