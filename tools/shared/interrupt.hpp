// SPDX-License-Identifier: MIT
#pragma once

#include "shared/exit_codes.hpp"

namespace taut::tools
{

/// Ctrl-C (SIGINT), SIGTERM and the end of the time limit. All threads block the signals, but for one that waits for
/// them: a handler that others install is never entered (LLVM's, in an OpenCL driver, deletes the files that the driver
/// is about to read), and programs that the driver starts do not notice.
///
/// While a run has nothing to keep, each of them ends the program at once, with a message: nothing is lost, whatever
/// the threads are doing. From keep(true) on, the first signal only makes interrupted() true, which observers ask, and
/// the second one ends the program; the time limit is then the solver's affair.

/// To be called once, before there are other threads.
void watch_interrupts();

/// The program ends with code 6 so many seconds from now if it has nothing to keep then. Infinite: never.
void limit_time(double seconds);

/// Returns whether there is something that a run which stops would write: a map, even if only the best of those with
/// flips.
void keep(bool something);

/// Returns whether a run that has something to keep was asked to stop. Cheap, callable from any thread.
bool interrupted() noexcept;

/// The exit code of the signal that asked, `interrupted` or `terminated`.
exit_code interruption() noexcept;

} // namespace taut::tools
