// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/io/atomic_file.hpp>

#include "../child.hpp"
#include "job.hpp"
#include "job_files.hpp"

namespace taut::tools::batch
{

/// Files and the hashes of their contents; nothing where there was nothing to hash.
using hashes = std::map<std::string, std::optional<std::string>>;

hashes hashes_of(const std::vector<std::string>& paths);

/// What became of a job, as a JSON object, docs/batch.md.
using result = nlohmann::ordered_json;

/// One word for how a job ended: a promise to scripts, as the exit codes are.
std::string outcome_of(const child_end& end);

/// inputs: before it was run; outputs: those that it wrote
result make_result(const job& done, const child_end& end, const hashes& inputs, const hashes& outputs,
                   const std::optional<nlohmann::ordered_json>& stats);

/// Whether a result is one of success: a map that was asked for is there.
bool succeeded(const result& r);

/// Whether a result still stands: the same arguments, inputs with the same content as then, or as the job left them,
/// and outputs that exist.
bool stands(const result& r, const job& wanted, const job_files& files);

/// The lines of results, to which several runs may append at once.
class result_file
{
public:
    /// Cuts off a last line that was not finished. Throws io_error.
    explicit result_file(const std::string& path);

    /// The last result of each id, without what it printed. Lines that are none are passed over.
    std::map<std::string, result> read() const;

    /// Appends a line and brings it to the disk: it is there as a whole or not at all. Throws io_error.
    void append(const result& r);

private:
    std::string path_;
    io::detail::descriptor file_; ///< none where what is written goes on at once: a pipe, standard output
};

} // namespace taut::tools::batch
