// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace taut::tools
{

/// What may end a run before its time.
enum class stop_signal
{
    interrupt, ///< SIGINT: Ctrl-C
    terminate, ///< SIGTERM, SIGQUIT, SIGHUP unless ignored; Windows: the window is closed, the user logs off
    alarm      ///< of set_alarm()
};

/// From now on a thread of its own calls take() for each of them. To be called once, before there are other threads.
void watch_signals(void (*take)(stop_signal));

/// One alarm so many seconds from now. Infinite: never.
void set_alarm(double seconds);

/// Waits until something happens to the process, or for some time.
void wait_for_signals() noexcept;

/// A message on standard error in the place of a bar of progress, unless nobody reads it.
void tell_if_read(const std::string& text) noexcept;

} // namespace taut::tools
