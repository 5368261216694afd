// SPDX-License-Identifier: MIT
#include "batch/job_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include <taut/errors.hpp>

namespace taut::tools::batch
{

job_stream::job_stream(int file, std::string name,
                       std::function<void(const std::string& id, const std::string& why)> refuse)
    : file_(file), name_(std::move(name)), refuse_(std::move(refuse))
{
}

void job_stream::read(std::deque<job>& jobs)
{
    // What is there, but for so much that jobs at work would wait.
    constexpr int most_pieces = 256;
    char some[1 << 16];
    std::size_t begin = 0;
    const std::size_t searched = rest_.size(); // that much has no end of a line
    for (int piece = 0; piece < most_pieces && !ended_; ++piece)
    {
        pollfd news{file_, POLLIN, 0};
        if (::poll(&news, 1, 0) <= 0) break;
        const auto count = ::read(file_, some, sizeof some);
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) break;
        if (count > 0)
            rest_.append(some, static_cast<std::size_t>(count));
        else
            ended_ = true;
    }
    for (std::size_t end; (end = rest_.find('\n', std::max(begin, searched))) != std::string::npos; begin = end + 1)
        take_line(rest_.substr(begin, end - begin), jobs);
    rest_.erase(0, begin);
    if (!ended_) return;
    if (!rest_.empty()) take_line(std::exchange(rest_, {}), jobs);
}

void job_stream::take_line(const std::string& text, std::deque<job>& jobs)
{
    ++lines_;
    try
    {
        auto one = parse_job(text, name_, lines_);
        if (!one) return;
        if (ids_.insert(one->id).second)
            jobs.push_back(std::move(*one));
        else
            refuse_(one->id, name_ + ", line " + std::to_string(lines_) + ": has the id of an earlier job");
    }
    catch (const io::io_error& e)
    {
        refuse_(id_in(text), e.what());
    }
}

} // namespace taut::tools::batch
