// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <taut/io/io_error.hpp>

namespace taut::io
{

/// A file that appears complete or not at all: it is written under another name in the same folder and renamed by
/// commit(). Without commit() nothing is left behind, and an older file of that name stays. A link is followed; what
/// is no regular file (a pipe, /dev/null) is written directly.
/// All members throw io_error, also where the disk is full.
class atomic_file
{
public:
    explicit atomic_file(const std::filesystem::path& path) : path_(path)
    {
        std::error_code ignored;
        if (std::filesystem::is_symlink(path, ignored)) path_ = target_of(path);
        const auto status = std::filesystem::status(path_, ignored);
        if (std::filesystem::is_directory(status)) fail(EISDIR);
        direct_ = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
        temporary_ = path_;
        if (!direct_) create_temporary();
        if (!direct_ && std::filesystem::exists(status))
            std::filesystem::permissions(temporary_, status.permissions(), ignored); // those of the file it replaces
        errno = 0;
        stream_.open(temporary_, std::ios::binary | std::ios::out);
        if (!stream_)
        {
            const int reason = errno;
            discard();
            fail(reason);
        }
    }

    ~atomic_file() { discard(); }

    atomic_file(const atomic_file&) = delete;
    atomic_file& operator=(const atomic_file&) = delete;

    /// Where to write. Its state need not be looked at: commit() does.
    std::ostream& stream() { return stream_; }

    void write(std::string_view text)
    {
        errno = 0;
        if (!stream_.write(text.data(), static_cast<std::streamsize>(text.size()))) fail(errno);
    }

    /// Finishes the file and gives it its name.
    void commit()
    {
        errno = 0;
        stream_.close(); // flushes: a full disk shows here at the latest
        if (!stream_) fail(errno);
        if (direct_) return;
        std::error_code failure;
        std::filesystem::rename(temporary_, path_, failure);
        if (failure) fail(failure.value());
        committed_ = true;
    }

private:
    /// What a link names, also where that does not exist yet.
    static std::filesystem::path target_of(const std::filesystem::path& link)
    {
        std::error_code failure;
        if (auto target = std::filesystem::canonical(link, failure); !failure) return target;
        const auto target = std::filesystem::read_symlink(link, failure);
        return failure ? link : link.parent_path() / target;
    }

    void create_temporary()
    {
        std::random_device random;
        for (int attempt = 0; attempt < 16; ++attempt)
        {
            // A short name of its own: the file's, made longer, might be too long.
            temporary_ = path_.parent_path() / (".taut-" + std::to_string(random()));
            errno = 0;
            // "x": fails if the name is taken.
            if (std::FILE* f = std::fopen(temporary_.string().c_str(), "wbx"))
            {
                std::fclose(f);
                return;
            }
            if (errno != EEXIST) break;
        }
        fail(errno);
    }

    void discard() noexcept
    {
        if (direct_ || committed_) return;
        stream_.close();
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
    }

    [[noreturn]] void fail(int number) const
    {
        throw io_error(path_.string(), "cannot write: " + std::generic_category().message(number != 0 ? number : EIO));
    }

    std::filesystem::path path_, temporary_;
    std::ofstream stream_;
    bool direct_ = false, committed_ = false;
};

} // namespace taut::io
