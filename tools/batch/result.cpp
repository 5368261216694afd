// SPDX-License-Identifier: MIT
#include "batch/result.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <istream>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch/content_hash.hpp"
#include "shared/exit_codes.hpp"
#include "shared/failure.hpp"

#include <taut/impl/files/file/atomic_file_bodies.hpp>

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

bool is_result(const earlier_result& r)
{
    const auto has = [&](const char* key, auto is) { return r.contains(key) && (r[key].*is)(); };
    return r.is_object() && has("id", &earlier_result::is_string) && has("args", &earlier_result::is_array) &&
           has("code", &earlier_result::is_number);
}

earlier_result parsed_line(const std::string& line)
{
    return earlier_result::parse(line, nullptr, false);
}

template <class Json>
Json to_json(const hashes& files)
{
    auto all = Json::object();
    for (const auto& [path, hash] : files) all[path] = hash ? Json(*hash) : nullptr;
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
    r["inputs"] = to_json<result>(inputs);
    r["outputs"] = to_json<result>(outputs);
    if (end.code != 0) r["error"] = last_words(end.complaints);
    if (stats)
        r["stats"] = *stats;
    else if (!end.printed.empty())
        r["printed"] = end.printed;
    return r;
}

bool stands(const earlier_result& r, const job& wanted, const job_files& files)
{
    if (r["args"] != wanted.args) return false;
    const auto no_files = earlier_result::object();
    const auto inputs = r.value("inputs", no_files), outputs = r.value("outputs", no_files);
    if (!inputs.is_object() || !outputs.is_object()) return false;
    const auto found = to_json<earlier_result>(hashes_of(files.inputs));
    if (found.size() != inputs.size()) return false; // a part of an input has come or gone
    for (const auto& [path, now] : found.items())
        if (now != inputs.value(path, no_files) && (now.is_null() || now != outputs.value(path, no_files)))
            return false;
    for (const auto& [path, hash] : outputs.items())
        if (::access(path.c_str(), F_OK) != 0) return false;
    return true;
}

result_ending ending_of(std::istream& text)
{
    static constexpr std::string_view begin = R"({"id":)"; // as append() writes it
    std::string first, last, line;
    result_ending found;
    bool ended = true;
    std::uintmax_t at = 0;
    for (; std::getline(text, line); at += line.size() + 1)
    {
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        found.last_begins = at;
        found.several = !first.empty();
        if (!found.several) first = line;
        last = line;
        ended = !text.eof();
    }
    if (first.empty()) return found;
    const bool broken = !ended && !earlier_result::accept(last);
    const bool begun = last.starts_with(begin) || (found.several && begin.starts_with(last));
    const bool ours = (broken && !found.several) || is_result(parsed_line(first));
    if (!ours || (broken && !begun))
        found.needs = result_ending::other_file;
    else if (!ended)
        found.needs = broken ? result_ending::cut : result_ending::line_end;
    return found;
}

std::map<std::string, earlier_result> parse_results(std::istream& text)
{
    std::map<std::string, earlier_result> last;
    for (std::string line; std::getline(text, line);)
    {
        auto r = parsed_line(line);
        if (!is_result(r)) continue;
        for (const char* long_one : {"stats", "printed"}) r.erase(long_one);
        const auto id = r["id"].get<std::string>();
        last[id] = std::move(r);
    }
    return last;
}

result_file::result_file(const std::string& path) : path_(path)
{
    if (io::impl::is_stream(path)) return;
    file_ = io::impl::descriptor(::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
    if (!file_) io::impl::cannot_write(path, errno);
    const file_lock held(*file_);
    std::ifstream in(path, std::ios::binary);
    const auto found = ending_of(in);
    if (found.needs == result_ending::other_file)
        throw usage_error("--output " + path + ": is there already, and its " +
                          (found.several ? "first or last" : "only") +
                          " line is no result of a batch; name another file, or move it away");
    if ((found.needs == result_ending::line_end && ::write(*file_, "\n", 1) != 1) ||
        (found.needs == result_ending::cut && ::ftruncate(*file_, static_cast<off_t>(found.last_begins)) != 0))
        io::impl::cannot_write(path, errno);
}

std::map<std::string, earlier_result> result_file::read() const
{
    std::ifstream in(path_, std::ios::binary);
    return parse_results(in);
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
            io::impl::cannot_write(path_, why);
        }
    }
    if (::fdatasync(*file_) != 0 && errno != EINVAL) io::impl::cannot_write(path_, errno);
}

} // namespace taut::tools::batch
