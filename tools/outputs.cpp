// SPDX-License-Identifier: MIT
#include "outputs.hpp"

#include <algorithm>
#include <system_error>

#include <poll.h>
#include <unistd.h>

#include <taut/io/atomic_file.hpp>

#include "failure.hpp"

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

/// One spelling for each file, whether it exists or not.
fs::path spelled_out(const fs::path& path)
{
    std::error_code ignored;
    auto full = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
    return full.empty() ? path : full;
}

/// Also by links, hard and symbolic.
bool same_file(const fs::path& a, const fs::path& b)
{
    std::error_code ignored;
    return fs::equivalent(a, b, ignored) || spelled_out(a) == spelled_out(b);
}

} // namespace

void outputs::add(const std::string& option, const fs::path& path, std::vector<std::string> extensions)
{
    if (path.empty()) return;
    const auto refuse = [&](const std::string& reason)
    { throw usage_error(option + ' ' + path.string() + ": " + reason); };

    std::error_code ignored;
    if (fs::is_directory(path, ignored)) refuse("is a folder; name a file");
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored)) refuse("there is no folder " + folder.string() + "; create it first");
    try
    {
        const auto target = io::detail::resolve_target(path);
        const bool named = !extensions.empty() && !target.stream;
        if (named && std::find(extensions.begin(), extensions.end(), extension(path)) == extensions.end())
        {
            std::string list;
            for (const auto& e : extensions) list += (list.empty() ? "" : " or ") + e;
            refuse("the name must end in " + list);
        }
        io::require_writable(path);
        standard_output_taken_ = standard_output_taken_ || target.number == STDOUT_FILENO;
    }
    catch (const io::io_error& e)
    {
        throw usage_error(option + ": " + e.what());
    }
    if (!fs::is_character_file(path, ignored)) // a terminal and /dev/null take anything
        for (const auto& other : outputs_)
            if (same_file(other.path, path)) refuse("is also the file of " + other.option + "; name another one");
    outputs_.push_back({option, path});
}

void outputs::protect(const std::string& what, const fs::path& input, const std::string& but_for) const
{
    std::error_code ignored;
    if (fs::exists(input, ignored) && !fs::is_regular_file(input, ignored)) return; // a pipe can be both
    for (const auto& o : outputs_)
        if (o.option != but_for && same_file(o.path, input))
            throw usage_error(o.option + ' ' + o.path.string() + ": would overwrite " + what);
}

const char* outputs::place_of_report() const
{
    const char* place = standard_output_taken_ ? "/dev/stderr" : standard_output;
    try
    {
        io::require_writable(place);
    }
    catch (const io::io_error& e)
    {
        throw usage_error(std::string(e.what()) + "; leave out the report with --quiet");
    }
    return place;
}

bool has_reader(const char* place_of_report)
{
    pollfd stream = {io::detail::resolve_target(place_of_report).number, POLLOUT, 0};
    return ::poll(&stream, 1, 0) < 1 || (stream.revents & (POLLERR | POLLHUP)) == 0;
}

std::string extension(const fs::path& path)
{
    std::string text = path.extension().string();
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return text;
}

std::string name_of_invalid(const std::string& output)
{
    return io::is_stream(output) ? std::string() : output + ".invalid";
}

void remove_invalid(const std::string& output)
{
    std::error_code ignored;
    const fs::path path = name_of_invalid(output);
    if (fs::is_regular_file(path, ignored)) fs::remove(path, ignored);
}

} // namespace taut::tools
