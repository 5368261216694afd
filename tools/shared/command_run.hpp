// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/files.hpp>

#include "shared/interrupt.hpp"
#include "shared/outputs.hpp"
#include "shared/progress.hpp"
#include "shared/report_files.hpp"
#include "shared/run_clock.hpp"
#include "shared/shared_options.hpp"

namespace taut::tools
{

/// Skeleton of a run of any command that writes results: its clock, its limit, which counts from the start of the
/// program, its progress, and its files and report, which appear together.
class command_run
{
public:
    /// options: checked by their check(), with `quiet`; and with `time_limit` and `progress` if the command has them.
    template <class Options>
    command_run(const Options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
        : clock(launch), progress_(mode_of(options), std::cerr)
    {
        if constexpr (requires { check(options); }) check(options);
        if (!options.quiet) place_of_report_ = files.place_of_report();
        if constexpr (requires { options.time_limit; }) limit_time(options.time_limit - clock.now());
    }

    /// Tells progress; the time is added.
    void tell(progress_report state)
    {
        state.seconds = clock.now();
        progress_.update(state);
    }
    void tell(std::string_view phase) { tell({.phase = phase}); }

    /// Ends the line of progress.
    void finish() { progress_.finish(); }

    /// Writes files of results, and with them the report as numbers, to options.stats, and as text: all or none. Note
    /// is called with the seconds since the start and those since the call, before either.
    template <class Report, class Options, class Note>
    void write(std::vector<io::file_to_write> files, const Report& report, const Options& options, Note note)
    {
        tell("write");
        const double begin = clock.now();
        write_with_report(std::move(files), report, options, place_of_report_, progress_,
                          [&] { note(clock.now(), clock.now() - begin); });
    }

    const run_clock clock;

private:
    template <class Options>
    static progress_mode mode_of(const Options& options)
    {
        if constexpr (requires { options.progress; })
            return progress_of(options.progress, options.quiet);
        else
            return progress_mode::none;
    }

    progress progress_;
    const char* place_of_report_ = nullptr; ///< null: there is none
};

} // namespace taut::tools
