// SPDX-License-Identifier: MIT
#include "result.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../exit_codes.hpp"
#include "content_hash.hpp"

namespace taut::tools::batch
{

namespace
{

/// The program's own message, or what was said last.
std::string last_words(const std::string& complaints)
{
    std::string last;
    for (std::size_t begin = 0; begin < complaints.size();)
    {
        const std::size_t end = std::min(complaints.find_first_of("\r\n", begin), complaints.size());
        std::string line = complaints.substr(begin, end - begin);
        if (line.starts_with("\x1b[K")) line.erase(0, 3);
        const auto is_message = [](const std::string& text) { return text.starts_with("taut: error: "); };
        if (line.find_first_not_of(" \t") != std::string::npos && (is_message(line) || !is_message(last)))
            last = std::move(line);
        begin = end + 1;
    }
    return last;
}

std::string word_of(int code)
{
    switch (static_cast<exit_code>(code))
    {
    case exit_code::valid:
        return "valid";
    case exit_code::usage:
        return "usage";
    case exit_code::unreadable_input:
        return "unreadable_input";
    case exit_code::unsuitable_input:
        return "unsuitable_input";
    case exit_code::no_device:
        return "no_device";
    case exit_code::no_valid_map:
        return "no_valid_map";
    case exit_code::infeasible:
        return "infeasible";
    case exit_code::time_limit:
        return "time_limit";
    case exit_code::device_failure:
        return "device_failure";
    case exit_code::some_failed:
        break; // of `taut batch`, which is no job
    case exit_code::interrupted:
        return "interrupted";
    case exit_code::terminated:
        return "terminated";
    }
    return code == 127 ? "not_started" : "internal_error";
}

/// Holds a file against other runs.
class file_lock
{
public:
    explicit file_lock(int file) : file_(file)
    {
        while (::flock(file_, LOCK_EX) != 0 && errno == EINTR)
        {
        }
    }
    ~file_lock() { ::flock(file_, LOCK_UN); }
    file_lock(const file_lock&) = delete;
    file_lock& operator=(const file_lock&) = delete;

private:
    int file_;
};

nlohmann::ordered_json to_json(const hashes& files)
{
    auto all = nlohmann::ordered_json::object();
    for (const auto& [path, hash] : files) all[path] = hash ? nlohmann::ordered_json(*hash) : nullptr;
    return all;
}

} // namespace

hashes hashes_of(const std::vector<std::string>& paths)
{
    hashes all;
    for (const auto& path : paths) all[path] = content_hash(path);
    return all;
}

std::string outcome_of(const child_end& end)
{
    if (end.by == child_end::time_limit) return "time_limit";
    if (end.by == child_end::memory_limit) return "memory_limit";
    return end.signal == 0 ? word_of(end.code) : end.signal == SIGKILL ? "killed" : "crashed";
}

result make_result(const job& done, const child_end& end, const hashes& inputs, const hashes& outputs,
                   const std::optional<nlohmann::ordered_json>& stats)
{
    result r;
    r["id"] = done.id;
    r["args"] = done.args;
    r["code"] = end.code;
    r["outcome"] = outcome_of(end);
    if (end.signal != 0) r["signal"] = std::string("SIG") + ::sigabbrev_np(end.signal);
    r["seconds"] = end.seconds;
    r["cpu_seconds"] = end.cpu_seconds;
    r["peak_memory"] = end.peak_memory;
    r["inputs"] = to_json(inputs);
    r["outputs"] = to_json(outputs);
    if (end.code != 0) r["error"] = last_words(end.complaints);
    if (stats)
        r["stats"] = *stats;
    else if (!end.printed.empty())
        r["printed"] = end.printed;
    return r;
}

bool succeeded(const result& r)
{
    const auto code = r.find("code");
    return code != r.end() && (*code == to_int(exit_code::valid) || *code == to_int(exit_code::time_limit));
}

bool stands(const result& r, const job& wanted, const job_files& files)
{
    if (!r.contains("args") || r["args"] != wanted.args) return false;
    const auto no_files = nlohmann::ordered_json::object();
    const auto inputs = r.value("inputs", no_files), outputs = r.value("outputs", no_files);
    const auto found = to_json(hashes_of(files.inputs));
    for (const auto& [path, now] : found.items())
        if (now != inputs.value(path, no_files) && (now.is_null() || now != outputs.value(path, no_files)))
            return false;
    for (const auto& [path, hash] : outputs.items())
        if (::access(path.c_str(), F_OK) != 0) return false;
    return true;
}

result_file::result_file(const std::string& path) : path_(path)
{
    if (io::is_stream(path)) return;
    file_ = io::detail::descriptor(::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
    if (!file_) io::detail::cannot_write(path, errno);
    const file_lock held(*file_);
    const off_t before = ::lseek(*file_, 0, SEEK_END);
    off_t length = before;
    for (char last = 0; length > 0 && ::pread(*file_, &last, 1, length - 1) == 1 && last != '\n';) --length;
    if (length < before && ::ftruncate(*file_, length) != 0) io::detail::cannot_write(path, errno);
}

std::map<std::string, result> result_file::read() const
{
    std::map<std::string, result> last;
    std::ifstream in(path_, std::ios::binary);
    for (std::string line; std::getline(in, line);)
    {
        result r = result::parse(line, nullptr, false);
        if (!r.is_object() || !r.contains("id") || !r["id"].is_string()) continue;
        for (const char* long_one : {"stats", "printed"}) r.erase(long_one);
        const auto id = r["id"].get<std::string>();
        last[id] = std::move(r);
    }
    return last;
}

void result_file::append(const result& r)
{
    const std::string line = r.dump(-1, ' ', false, result::error_handler_t::replace) + '\n';
    if (!file_) return io::write_file(path_, line);
    const file_lock held(*file_);
    const off_t before = ::lseek(*file_, 0, SEEK_END);
    for (std::size_t at = 0; at < line.size();)
    {
        const auto written = ::write(*file_, line.data() + at, line.size() - at);
        if (written >= 0)
            at += static_cast<std::size_t>(written);
        else if (const int why = errno; why != EINTR)
        {
            if (::ftruncate(*file_, before) != 0) errno = 0; // the next run cuts it off
            io::detail::cannot_write(path_, why);
        }
    }
    if (::fdatasync(*file_) != 0 && errno != EINVAL) io::detail::cannot_write(path_, errno);
}

} // namespace taut::tools::batch
