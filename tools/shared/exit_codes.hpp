// SPDX-License-Identifier: MIT
#pragma once

namespace taut::tools
{

/// Exit codes of the program, stable for scripts.
/// `valid` and `time_limit` leave a map behind that is certified to have no flipped element, `interrupted` and
/// `terminated` do if there was one by then; others leave none.
enum class exit_code : int
{
    valid = 0,            ///< a valid map was written
    usage = 2,            ///< unknown option, wrong argument, or an output that cannot be written; no file has changed
    unreadable_input = 3, ///< a file does not exist or cannot be understood
    unsuitable_input = 4, ///< a mesh or constraints that no map exists for: not a disk, contradicting pins, ...
    no_device = 5,        ///< no OpenCL device, or none that can do the work
    no_valid_map = 6,     ///< the solver, or its time, ended without a map free of flips; nothing is written as one
    infeasible = 7,       ///< it is proved that no valid map exists; nothing was written
    time_limit = 8,       ///< time ran out; the best valid map so far was written
    device_failure = 9,   ///< the device or its driver failed: build error, out of memory, lost device
    some_failed = 10,     ///< of a batch: all jobs were run, and the results say which of them failed
    interrupted = 130,    ///< Ctrl-C, 128 + SIGINT as shells report it; the best valid map so far was written, if any
    terminated = 143      ///< SIGTERM, the same
};

constexpr int to_int(exit_code code)
{
    return static_cast<int>(code);
}

/// One line for --help and error messages.
constexpr const char* describe(exit_code code)
{
    switch (code)
    {
    case exit_code::valid:
        return "a valid map was written";
    case exit_code::usage:
        return "wrong usage";
    case exit_code::unreadable_input:
        return "an input file cannot be read";
    case exit_code::unsuitable_input:
        return "the input is not suitable";
    case exit_code::no_device:
        return "no suitable OpenCL device";
    case exit_code::no_valid_map:
        return "no valid map was found";
    case exit_code::infeasible:
        return "no valid map exists";
    case exit_code::time_limit:
        return "time limit reached, the best valid map was written";
    case exit_code::device_failure:
        return "the OpenCL device failed";
    case exit_code::some_failed:
        return "some jobs failed";
    case exit_code::interrupted:
        return "interrupted";
    case exit_code::terminated:
        return "terminated";
    }
    return "unknown";
}

} // namespace taut::tools
