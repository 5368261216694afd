// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/files.hpp>

#include "shared/outputs.hpp"
#include "shared/progress.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

/// JSON as a file has it. File names need not be UTF-8.
inline std::string text_of(const nlohmann::ordered_json& json)
{
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

/// The report as numbers.
template <class Report, class Options>
void write_stats(io::atomic_file& file, const Report& report, const Options& options)
{
    file.write(text_of(to_json(report, options)));
}

/// Writes files of results, and with them, all or none, the report as numbers and as text where these are asked for.
/// All files appear together, so the report comes before them: where it cannot be printed, nothing has changed.
/// options.stats: a file, or empty; place: of the text, null if there is none; note_time: what the report says of time
template <class Report, class Options>
void write_with_report(std::vector<io::file_to_write> files, const Report& report, const Options& options,
                       const char* place, progress& shown, const std::function<void()>& note_time)
{
    if (!options.stats.empty())
        files.push_back({options.stats, [&](io::atomic_file& file)
                         {
                             note_time();
                             write_stats(file, report, options);
                         }});
    if (place && has_reader(place))
        files.push_back({place, [&](io::atomic_file& file)
                         {
                             note_time();
                             shown.finish();
                             file.write(text_of(report, options));
                         }});
    writing([&] { io::write_files(files); });
    shown.finish();
}

} // namespace taut::tools
