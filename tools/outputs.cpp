// SPDX-License-Identifier: MIT
#include "outputs.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

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

bool is_special(const fs::path& path)
{
    std::error_code ignored;
    return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored) && !fs::is_directory(path, ignored);
}

} // namespace

void outputs::add(const std::string& option, const fs::path& path, std::vector<std::string> extensions)
{
    if (path.empty()) return;
    const auto refuse = [&](const std::string& reason)
    { throw usage_error(option + ' ' + path.string() + ": " + reason); };

    std::error_code ignored;
    if (fs::is_directory(path, ignored)) refuse("is a folder; name a file");
    if (is_special(path)) return;
    if (!extensions.empty() && std::find(extensions.begin(), extensions.end(), extension(path)) == extensions.end())
    {
        std::string list;
        for (const auto& e : extensions) list += (list.empty() ? "" : " or ") + e;
        refuse("the name must end in " + list);
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored)) refuse("there is no folder " + folder.string() + "; create it first");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        refuse("cannot write into folder " + folder.string() + ": " + std::strerror(errno));

    const fs::path full = spelled_out(path);
    for (const auto& other : outputs_)
        if (other.path == full) refuse("is also the file of " + other.option);
    outputs_.push_back({option, full});
}

void outputs::protect(const fs::path& input) const
{
    std::error_code ignored;
    for (const auto& o : outputs_)
        if (o.path == spelled_out(input) || fs::equivalent(o.path, input, ignored))
            throw usage_error(o.option + ' ' + o.path.string() + ": would overwrite the input");
}

std::string extension(const fs::path& path)
{
    std::string text = path.extension().string();
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return text;
}

bool names_a_file(const fs::path& path)
{
    std::error_code ignored;
    return !fs::exists(path, ignored) || fs::is_regular_file(path, ignored);
}

void write_text(const fs::path& path, std::string_view text)
{
    io::atomic_file file(path);
    file.write(text);
    file.commit();
}

} // namespace taut::tools
