// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/files/file/file_target.hpp>

#include <cerrno>
#include <system_error>

#include <taut/errors.hpp>

namespace taut::io::impl
{

void cannot_write(const std::filesystem::path& path, int number, const std::string& more)
{
    throw io_error(path.string(),
                   "cannot write: " + std::generic_category().message(number != 0 ? number : EIO) + more);
}

int open_file_number(const std::filesystem::path& path)
{
    if (path == "/dev/stdin") return 0;
    if (path == "/dev/stdout") return 1;
    if (path == "/dev/stderr") return 2;
    const std::string name = path.filename().string();
    if (name.empty() || name.size() > 8 || name.find_first_not_of("0123456789") != name.npos) return -1;
    std::error_code missing;
    const auto all = std::filesystem::canonical("/dev/fd", missing);
    if (missing || std::filesystem::canonical(path.parent_path(), missing) != all || missing) return -1;
    return std::stoi(name);
}

file_target resolve_target(std::filesystem::path path)
{
    const auto named = path;
    for (int links = 0; links < 40; ++links)
    {
        if (const int number = open_file_number(path); number >= 0) return {path, number, true};
        std::error_code failure;
        const auto status = std::filesystem::status(path, failure);
        if (path.filename().empty() || std::filesystem::is_directory(status)) cannot_write(named, EISDIR);
        if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return {path, -1, true};
        if (!std::filesystem::is_symlink(path, failure)) return {path};
        const auto next = std::filesystem::read_symlink(path, failure);
        if (failure) cannot_write(named, failure.value());
        path = path.parent_path() / next; // `next` alone, if that is absolute
    }
    cannot_write(named, ELOOP);
}

} // namespace taut::io::impl
