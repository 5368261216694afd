// SPDX-License-Identifier: MIT
#include "batch/job_conflicts.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include <taut/impl/io/file/file_target.hpp>

#include "batch/job_files.hpp"
#include "shared/failure.hpp"
#include "shared/file_identity.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools::batch
{

namespace
{

struct file_of_job
{
    std::size_t job;
    bool written;
    std::string name;
    file_identity identity;
};

/// Returns whether a name stands for a file that only one job may use, if it is written: each job has standard streams
/// of its own, a terminal and /dev/null take anything, and a pipe can be both.
bool is_owned(const std::string& name, bool written)
{
    if (io::impl::open_file_number(name) >= 0) return false;
    std::error_code ignored;
    const auto status = std::filesystem::status(name, ignored);
    return written ? !std::filesystem::is_character_file(status)
                   : !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

class conflict_search
{
public:
    conflict_search(const std::vector<job>& jobs, const std::string& manifest) : jobs_(jobs), manifest_(manifest)
    {
        argument_reader arguments;
        for (std::size_t j = 0; j < jobs.size(); ++j)
        {
            const auto found = arguments.files(jobs[j].args);
            for (const auto& name : found.outputs) add(j, true, name);
            for (const auto& name : found.inputs) add(j, false, name);
        }
    }

    void operator()() const
    {
        std::map<std::string, std::vector<const file_of_job*>> by_name;
        std::map<file_identity::node, std::vector<const file_of_job*>> by_number;
        for (const auto& one : files_)
        {
            by_name[one.identity.spelled()].push_back(&one);
            if (const auto& number = one.identity.number()) by_number[*number].push_back(&one);
        }
        for (const auto& [_, same] : by_name) require_one_writer(same);
        for (const auto& [_, same] : by_number) require_one_writer(same);
        for (const auto& tiles : files_) // written, they may become any tile
            if (names_tiles(tiles.name))
                for (const auto& one : files_)
                    if (is_tile_file(tiles.identity.spelled(), one.identity.spelled()))
                        require_one_writer({&tiles, &one});
    }

private:
    void add(std::size_t job, bool written, const std::string& name)
    {
        if (is_owned(name, written)) files_.push_back({job, written, name, file_identity(name)});
    }

    /// same: uses of one file
    void require_one_writer(const std::vector<const file_of_job*>& same) const
    {
        const auto writer = std::find_if(same.begin(), same.end(), [](const auto* one) { return one->written; });
        if (writer == same.end()) return;
        const auto other =
            std::find_if(same.begin(), same.end(), [&](const auto* one) { return one->job != (*writer)->job; });
        if (other == same.end()) return;
        const auto& w = **writer;
        const auto& o = **other;
        const std::string also = o.name == w.name ? "" : ", as " + o.name;
        throw usage_error(manifest_ + ": job " + jobs_[w.job].id + " would write " + w.name + ", which job " +
                          jobs_[o.job].id + (o.written ? " writes, too" : " reads") + also + "; name another file");
    }

    const std::vector<job>& jobs_;
    const std::string& manifest_;
    std::vector<file_of_job> files_;
};

} // namespace

void require_own_files(const std::vector<job>& jobs, const std::string& manifest)
{
    conflict_search{jobs, manifest}();
}

} // namespace taut::tools::batch
