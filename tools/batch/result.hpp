// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/files.hpp>

#include "batch/job.hpp"
#include "batch/job_files.hpp"
#include "shared/child.hpp"
#include "shared/exit_codes.hpp"

namespace taut::tools::batch
{

/// Files and the hashes of their contents; nothing where there was nothing to hash.
using hashes = std::map<std::string, std::optional<std::string>>;

hashes hashes_of(const std::vector<std::string>& paths);

/// Result of a job, as a JSON object, docs/howto/batch.md.
using result = nlohmann::ordered_json;

/// One word for how a job ended: a promise to scripts, as the exit codes are.
std::string outcome_of(const child_end& end);

/// inputs: before it was run; outputs: those that it wrote
result make_result(const job& done, const child_end& end, const hashes& inputs, const hashes& outputs,
                   const std::optional<nlohmann::ordered_json>& stats);

/// One that was read back, whose keys have another order. (An ordered object looks through all keys for each.)
using earlier_result = nlohmann::json;

/// Returns whether a result is one of success: a map that was asked for is there.
template <class Json>
bool succeeded(const Json& r)
{
    return r["code"] == to_int(exit_code::valid) || r["code"] == to_int(exit_code::time_limit);
}

/// Returns whether a result still stands: the same arguments, inputs with the same content as then, or as the job left
/// them, and outputs that exist.
bool stands(const earlier_result& r, const job& wanted, const job_files& files);

/// Repair that a file needs before results can be appended to it.
struct result_ending
{
    enum need
    {
        nothing,
        line_end,  ///< the last line is whole, but for its end
        cut,       ///< the last line is the beginning of a result: a run was cut off
        other_file ///< it is no file of results
    };
    need needs = nothing;
    std::uintmax_t last_begins = 0; ///< the last line that is not empty: byte of the file
    bool several = false;           ///< lines
};

result_ending ending_of(std::istream& text);

/// The last result of each id, without what it printed. Lines that are none are passed over.
std::map<std::string, earlier_result> parse_results(std::istream& text);

/// The lines of results, to which several runs may append at once.
class result_file
{
public:
    /// Cuts off a result that was not finished, as a machine that went down leaves it. Throws usage_error for a file
    /// that has other lines, which stays as it is; io_error.
    explicit result_file(const std::string& path);

    /// Its parse_results().
    std::map<std::string, earlier_result> read() const;

    /// Appends a line and brings it to the disk: it is there as a whole or not at all. Throws io_error.
    void append(const result& r);

private:
    std::string path_;
    io::impl::descriptor file_; ///< none where what is written goes on at once: a pipe, standard output
};

} // namespace taut::tools::batch
