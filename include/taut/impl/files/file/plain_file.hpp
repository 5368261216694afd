// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <taut/impl/files/file/file_target.hpp>
#include <taut/impl/files/file/open_file.hpp>

namespace taut::io::impl
{

/// File operations of atomic_file by the standard library alone: unfinished files have a hidden name.
class plain_file
{
public:
    explicit plain_file(file_target target) : target_(std::move(target)), name_(target_.path)
    {
        if (!target_.stream) name_.replace_filename(".taut-" + std::to_string(std::random_device()()));
        errno = 0;
        if (target_.number >= 0)
            file_ = open_number(target_.number, "wb");
        else
            file_ = target_.stream ? open_name(name_, "wb") : open_new(name_);
        if (!file_) cannot_write(target_.path, errno);
    }
    ~plain_file()
    {
        std::error_code ignored;
        file_.reset();
        if (!target_.stream && name_ != target_.path) std::filesystem::remove(name_, ignored);
    }
    plain_file(const plain_file&) = delete;
    plain_file& operator=(const plain_file&) = delete;

    void write(std::string_view text)
    {
        errno = 0;
        if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) cannot_write(target_.path, errno);
    }

    void finish()
    {
        errno = 0;
        if (std::fflush(file_.get()) != 0) cannot_write(target_.path, errno); // a full disk shows here at the latest
        file_.reset();
        std::error_code missing;
        const auto old = std::filesystem::status(target_.path, missing);
        if (!target_.stream && std::filesystem::exists(old))
            std::filesystem::permissions(name_, old.permissions(), missing);
    }

    void link() {}

    void rename(const std::string& otherwise = {})
    {
        if (target_.stream) return;
        std::error_code failure;
        std::filesystem::rename(name_, target_.path, failure);
        if (failure) cannot_write(target_.path, failure.value(), otherwise);
        name_ = target_.path;
    }

    void sync_folder() {}

    static void require_writable(const file_target& target)
    {
        if (!target.stream) plain_file(target).write("?");
    }

private:
    file_target target_;
    std::filesystem::path name_; ///< that the file has now
    open_file file_{nullptr, &std::fclose};
};

} // namespace taut::io::impl
