// SPDX-License-Identifier: MIT
#include "shared/interrupt.hpp"

#include <atomic>
#include <cstdlib>
#include <string>

#include <taut/files.hpp>
#include <taut/impl/files/file/atomic_file.hpp>

#include "shared/stop_signals.hpp"
#include "shared/temporary_folder.hpp"

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
std::atomic<stop_signal> asked_by{stop_signal::interrupt};

/// Never returns to a thread that still asks while the program is ended: what is done from here on is done for nobody.
standing present() noexcept
{
    standing now = state;
    for (; now == standing::leaving; now = state) wait_for_signals();
    return now;
}

exit_code code_of(stop_signal signal) noexcept
{
    return signal == stop_signal::terminate ? exit_code::terminated : exit_code::interrupted;
}

/// Ends the program without a look at what other threads are doing.
[[noreturn]] void leave(exit_code code, const std::string& why)
{
    tell_if_read("taut: error: " + why + '\n');
    io::impl::remove_temporaries();
    remove_temporary_folders();
    std::_Exit(to_int(code));
}

void take(stop_signal signal)
{
    auto now = standing::nothing;
    const bool lossless = state.compare_exchange_strong(now, standing::leaving);
    if (signal == stop_signal::alarm)
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

} // namespace

void watch_interrupts()
{
    watch_signals(&take);
}

void limit_time(double seconds)
{
    set_alarm(seconds);
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
