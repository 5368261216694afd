// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <taut/io/io_error.hpp>

namespace taut::io
{

/// All bytes of a file, or of a pipe. Throws io_error.
inline std::string read_file(const std::filesystem::path& path)
{
    const auto fail = [&](int number) { throw io_error(path.string(), std::generic_category().message(number)); };
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) fail(EISDIR);

    errno = 0;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.string().c_str(), "rb"), &std::fclose);
    if (!file) fail(errno != 0 ? errno : EIO);

    // The size is a hint: a pipe has none, and a file may grow meanwhile.
    const auto size = std::filesystem::file_size(path, ignored);
    std::string text(ignored ? 1 << 16 : static_cast<std::size_t>(size) + 1, '\0');
    std::size_t used = 0;
    while (const std::size_t n = std::fread(text.data() + used, 1, text.size() - used, file.get()))
    {
        used += n;
        if (used == text.size()) text.resize(2 * used);
    }
    if (std::ferror(file.get()) != 0) fail(errno != 0 ? errno : EIO);
    text.resize(used);
    return text;
}

} // namespace taut::io
