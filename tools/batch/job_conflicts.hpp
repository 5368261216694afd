// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "batch/job.hpp"
#include "batch/job_files.hpp"
#include "shared/file_identity.hpp"

namespace taut::tools::batch
{

/// What a batch itself reads and writes.
struct batch_files
{
    std::string jobs;  ///< the manifest, or standard input
    std::string out;   ///< of results
    std::string cache; ///< folder of compiled kernels
};

/// A search for files that one job writes and another one writes or reads, or the batch itself, by whatever name.
class job_conflicts
{
public:
    explicit job_conflicts(const batch_files& own);

    void add(const std::string& id, const job_files& files);

    /// "job a would write flat.obj, which job b reads; name another file"; empty: there is none.
    std::string found() const;

private:
    static constexpr std::size_t batch = static_cast<std::size_t>(-1);
    struct use
    {
        std::size_t job;
        bool written;
        std::string name;
        file_identity identity;
    };

    std::string name_of(std::size_t job) const { return job == batch ? "the batch itself" : "job " + ids_[job]; }
    /// The conflict among uses of one file.
    std::string conflict(const std::vector<const use*>& same) const;
    std::string in_cache() const;

    std::vector<std::string> ids_;
    std::vector<use> uses_;
    file_identity cache_;
};

/// Jobs of a manifest run at once, in parts of it, and again: throws usage_error where there is a conflict.
void require_own_files(const std::vector<job>& jobs, const batch_files& own);

} // namespace taut::tools::batch
