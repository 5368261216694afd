// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/files/file/read_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <system_error>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <taut/errors.hpp>
#include <taut/impl/files/file/file_target.hpp>

namespace taut::io::impl
{

open_file open_to_read(const std::filesystem::path& path)
{
    errno = 0;
    if (const int number = open_file_number(path); number >= 0) return open_number(number, "rb");
    return open_name(path, "rb");
}

std::uint64_t most_bytes_to_read()
{
#if defined(__unix__) || defined(__APPLE__)
    const auto pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    std::uint64_t memory =
        pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : UINT64_MAX;
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        memory = std::min<std::uint64_t>(memory, limit.rlim_cur);
    return memory / 4;
#else
    return std::uint64_t(16) << 30;
#endif
}

std::optional<std::filesystem::path> path_within(const std::filesystem::path& folder, const std::filesystem::path& file)
{
    std::error_code unknown;
    const auto root = std::filesystem::canonical(folder.empty() ? "." : folder, unknown);
    if (unknown) return std::nullopt;
    auto real = std::filesystem::canonical(file, unknown);
    if (unknown || std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first != root.end())
        return std::nullopt;
    return real;
}

std::string read_file(const std::filesystem::path& path, std::uint64_t most)
{
    const auto fail = [&](int number)
    { throw io_error(path.string(), std::generic_category().message(number != 0 ? number : EIO)); };
    const auto check_size = [&](std::uint64_t size)
    {
        if (size > most)
            throw io_error(path.string(), "has more than " + std::to_string(most >> 20) +
                                              " MiB, the most that is read with the memory there is");
    };
    std::error_code unknown;
    if (std::filesystem::is_directory(path, unknown)) throw io_error(path.string(), a_folder);
    const auto file = impl::open_to_read(path);
    if (!file) fail(errno);

    // The size is a hint: a pipe has none, and a file may grow meanwhile.
    const auto size = std::filesystem::file_size(path, unknown);
    if (!unknown) check_size(size);
    std::string text(unknown ? 1 << 16 : static_cast<std::size_t>(size) + 1, '\0');
    std::size_t used = 0;
    while (const std::size_t n = std::fread(text.data() + used, 1, text.size() - used, file.get()))
    {
        used += n;
        check_size(used);
        if (used == text.size()) text.resize(static_cast<std::size_t>(std::min<std::uint64_t>(2 * used, most + 1)));
    }
    if (std::ferror(file.get()) != 0) fail(errno);
    text.resize(used);
    return text;
}

} // namespace taut::io::impl
