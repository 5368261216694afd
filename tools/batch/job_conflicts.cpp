// SPDX-License-Identifier: MIT
#include "batch/job_conflicts.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/impl/files/file/file_target.hpp>

#include "shared/failure.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools::batch
{

namespace
{

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

/// Standard streams of a batch may be files by redirection.
bool is_file_of_batch(const std::string& name)
{
    std::error_code ignored;
    return io::impl::open_file_number(name) < 0 || std::filesystem::is_regular_file(name, ignored);
}

} // namespace

job_conflicts::job_conflicts(const batch_files& own) : cache_(own.cache)
{
    for (const auto& [name, written] :
         {std::pair(own.jobs, false), std::pair(own.out, true), std::pair(std::string("/dev/stderr"), true)})
        if (is_file_of_batch(name)) uses_.push_back({batch, written, name, file_identity(name)});
}

void job_conflicts::add(const std::string& id, const job_files& files)
{
    for (const bool written : {true, false})
        for (const auto& name : written ? files.outputs : files.inputs)
            if (is_owned(name, written)) uses_.push_back({ids_.size(), written, name, file_identity(name)});
    ids_.push_back(id);
}

std::string job_conflicts::found() const
{
    std::map<std::string, std::vector<const use*>> by_name;
    std::map<file_identity::node, std::vector<const use*>> by_number;
    for (const auto& one : uses_)
    {
        by_name[one.identity.spelled()].push_back(&one);
        if (const auto& number = one.identity.number()) by_number[*number].push_back(&one);
    }
    for (const auto& [_, same] : by_name)
        if (auto why = conflict(same); !why.empty()) return why;
    for (const auto& [_, same] : by_number)
        if (auto why = conflict(same); !why.empty()) return why;
    for (const auto& tiles : uses_) // written, they may become any tile
        if (names_tiles(tiles.name))
            for (const auto& one : uses_)
                if (is_tile_file(tiles.identity.spelled(), one.identity.spelled()))
                    if (auto why = conflict({&tiles, &one}); !why.empty()) return why;
    return in_cache();
}

std::string job_conflicts::conflict(const std::vector<const use*>& same) const
{
    const auto is_writer = [](const use* one) { return one->written; };
    auto writer =
        std::find_if(same.begin(), same.end(), [&](const use* one) { return is_writer(one) && one->job != batch; });
    if (writer == same.end()) writer = std::find_if(same.begin(), same.end(), is_writer);
    if (writer == same.end()) return {};
    const auto other =
        std::find_if(same.begin(), same.end(), [&](const use* one) { return one->job != (*writer)->job; });
    if (other == same.end()) return {};
    const auto &w = **writer, &o = **other;
    const bool of_batch = w.job == batch; // then the job is told what it would do
    const use &here = of_batch ? o : w, &there = of_batch ? w : o;
    return name_of(here.job) + " would " + (here.written ? "write " : "read ") + here.name + ", which " +
           name_of(there.job) +
           (!there.written ? " reads"
            : here.written ? " writes, too"
                           : " writes") +
           (there.name == here.name ? "" : ", as " + there.name) + "; name another file";
}

std::string job_conflicts::in_cache() const
{
    for (const auto& one : uses_)
        if (one.job != batch && one.written && one.identity.spelled().starts_with(cache_.spelled() + '/'))
            return name_of(one.job) + " would write " + one.name +
                   ", where the batch keeps compiled kernels; name another file";
    return {};
}

void require_own_files(const std::vector<job>& jobs, const batch_files& own)
{
    job_conflicts all(own);
    argument_reader arguments;
    for (const auto& one : jobs) all.add(one.id, arguments.files(one.args));
    if (const auto why = all.found(); !why.empty()) throw usage_error(own.jobs + ": " + why);
}

} // namespace taut::tools::batch
