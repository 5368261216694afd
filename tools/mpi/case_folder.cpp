// SPDX-License-Identifier: MIT
#include "mpi/case_folder.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>

#include <taut/errors.hpp>
#include <taut/files.hpp>
#include <taut/impl/files/file/read_file.hpp>

namespace taut::tools::mpi
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* list_name = "taut-checkpoint";
constexpr std::string_view list_head = "files of a checkpoint of taut-mpi, which removes them:";

/// One spelling for each file, whether it is there or not.
fs::path spelled(const fs::path& path)
{
    std::error_code unknown;
    auto full = fs::weakly_canonical(fs::absolute(path, unknown), unknown);
    return full.has_filename() ? full : full.parent_path(); // as "case/"
}

/// Lines below the head of a list; none where it is no list, or is not there.
std::set<std::string> files_of_list(const fs::path& list)
{
    std::error_code unknown;
    std::set<std::string> files;
    if (!fs::is_regular_file(fs::symlink_status(list, unknown))) return files;
    const std::string text = io::impl::read_file(list);
    if (!text.starts_with(list_head)) return files;
    files.insert(list_name);
    for (std::size_t begin = text.find('\n'), end = 0; begin != text.npos && ++begin < text.size(); begin = end)
        files.insert(text.substr(begin, (end = text.find('\n', begin)) - begin));
    return files;
}

/// What a writer that was killed leaves.
bool is_unfinished(const fs::path& file)
{
    const std::string name = file.filename().string();
    return name.size() == 22 && name.starts_with(".taut-") &&
           name.find_first_not_of("0123456789abcdef", 6) == std::string::npos;
}

/// What lies in a folder, by the list that it has. Links are not followed.
struct content
{
    std::vector<fs::path> listed, strangers;
    std::vector<fs::path> folders; ///< of what is listed, each before those in it

    explicit content(const fs::path& folder)
    {
        std::error_code failure;
        if (fs::is_symlink(folder, failure))
        {
            strangers.push_back(folder);
            return;
        }
        const auto files = files_of_list(folder / list_name);
        std::set<fs::path> above;
        for (fs::path file : files)
            while (file.has_parent_path()) above.insert(file = file.parent_path());
        fs::recursive_directory_iterator at(folder, failure), end;
        for (; !failure && at != end; at.increment(failure))
        {
            const auto& path = at->path();
            const auto status = at->symlink_status(failure);
            const auto name = path.lexically_relative(folder);
            if (fs::is_directory(status) && above.count(name) != 0)
                folders.push_back(path);
            else if (fs::is_regular_file(status) &&
                     (files.count(name.string()) != 0 || (!files.empty() && is_unfinished(path))))
                listed.push_back(path);
            else
                strangers.push_back(path);
        }
        if (failure && failure != std::errc::no_such_file_or_directory) strangers.push_back(folder); // who knows
    }
};

} // namespace

bool same_folder(const fs::path& a, const fs::path& b)
{
    std::error_code unknown;
    return fs::equivalent(a, b, unknown) || spelled(a) == spelled(b);
}

bool lies_in(const fs::path& path, const fs::path& folder)
{
    for (auto here = spelled(path); !here.empty(); here = here.parent_path())
    {
        if (same_folder(here, folder)) return true;
        if (here == here.parent_path()) break;
    }
    return false;
}

std::string listed_folder::stranger() const
{
    const content found(folder_);
    return found.strangers.empty() ? std::string() : found.strangers.front().string();
}

void listed_folder::make(std::span<const std::string> files) const
{
    std::error_code failure;
    if (!fs::create_directory(folder_, failure))
        throw io::io_error(folder_.string(),
                           "cannot be made: " + (failure ? failure.message() : "is there already; move it away"));
    std::string list(list_head);
    for (const auto& file : files) list += '\n' + file;
    io::write_file(folder_ / list_name, list + '\n');
}

void listed_folder::remove() const
{
    const content found(folder_);
    std::error_code kept;
    if (found.listed.empty()) return;
    const auto list = folder_ / list_name;
    for (const auto& file : found.listed)
        if (file != list) fs::remove(file, kept);
    fs::remove(list, kept); // last, as it says what the others are
    for (auto folder = found.folders.rbegin(); folder != found.folders.rend(); ++folder) fs::remove(*folder, kept);
    fs::remove(folder_, kept);
}

void listed_folder::rename_to(const fs::path& name) const
{
    if (const auto other = listed_folder(name).stranger(); !other.empty())
        throw io::io_error(name.string(), "has a file that is none of a checkpoint, " + other +
                                              "; move it away, or name another folder");
    std::error_code failure;
#if defined(__linux__)
    if (::renameat2(AT_FDCWD, folder_.c_str(), AT_FDCWD, name.c_str(), RENAME_EXCHANGE) == 0)
    {
        remove();
        fs::remove(folder_, failure); // one that was empty
        return;
    }
#endif
    listed_folder(name).remove(); // not there, or of a file system that exchanges nothing
    fs::rename(folder_, name, failure);
    if (failure) throw io::io_error(name.string(), "cannot get its name: " + failure.message());
}

} // namespace taut::tools::mpi
