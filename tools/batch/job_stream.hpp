// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <set>
#include <string>

#include "batch/job.hpp"

namespace taut::tools::batch
{

/// Jobs of a manifest that is written while they run: standard input, a JSON object a line.
class job_stream
{
public:
    /// refuse: called with each line that is no job, and why it is none
    job_stream(int file, std::string name, std::function<void(const std::string& id, const std::string& why)> refuse);

    int file() const noexcept { return file_; }
    bool ended() const noexcept { return ended_; }
    /// Reads what is there, without a wait, and appends its jobs.
    void read(std::deque<job>& jobs);

private:
    void take_line(const std::string& text, std::deque<job>& jobs);

    int file_;
    std::string name_, rest_; ///< of a line whose end has not come
    std::function<void(const std::string&, const std::string&)> refuse_;
    std::set<std::string> ids_;
    std::size_t lines_ = 0;
    bool ended_ = false;
};

} // namespace taut::tools::batch
