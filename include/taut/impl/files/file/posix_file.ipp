// SPDX-License-Identifier: MIT
#pragma once

#include <taut/files.hpp>
#include <taut/impl/files/file/atomic_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace taut::io::impl
{

naming::naming() noexcept
{
    ++being_named;
    while (naming_is_over && waited_ < 1000) // for the end of the program
    {
        if (waited_++ == 0) --being_named;
        ::poll(nullptr, 0, 1);
    }
}

hidden_name::hidden_name(int folder) : folder_(folder)
{
    static constexpr char digits[] = "0123456789abcdef";
    std::random_device random;
    char* at = std::copy_n(".taut-", 6, name_.begin());
    for (int k = 0; k < 16; ++k) *at++ = digits[random() % 16];
    for (auto& place : removable_names)
    {
        int free = removable_name::free;
        if (!place.folder.compare_exchange_strong(free, removable_name::being_filled)) continue;
        place.name = name_;
        place.folder = folder_;
        place_ = &place;
        break;
    }
}

hidden_name::~hidden_name()
{
    if (!gone_) ::unlinkat(folder_, name(), 0);
    if (place_) place_->folder = removable_name::free;
}

posix_file::posix_file(file_target target, bool nameless) : target_(std::move(target))
{
    if (target_.stream)
        open_stream();
    else
        create(nameless);
}

void posix_file::write(std::string_view text)
{
    while (!text.empty())
    {
        const auto written = ::write(*file_, text.data(), text.size());
        if (written >= 0)
            text.remove_prefix(static_cast<std::size_t>(written));
        else if (errno == EAGAIN || errno == EWOULDBLOCK) // somebody made standard output non-blocking
            await_room();
        else if (errno != EINTR)
            fail();
    }
}

void posix_file::finish()
{
    if (target_.stream) return;
    if (replaced_)
    {
        if (::fchown(*file_, replaced_->st_uid, replaced_->st_gid) != 0) errno = 0; // only root gives files away
        if (::fchmod(*file_, replaced_->st_mode & 0777u) != 0) fail();
    }
    if (::fsync(*file_) != 0 && errno != EINVAL && errno != ENOTSUP) fail();
}

void posix_file::link()
{
    if (target_.stream || temporary_) return;
    const naming now;
    if (!now) cannot_write(target_.path, ECANCELED);
    temporary_.emplace(*folder_);
    if (::linkat(AT_FDCWD, own_path().c_str(), *folder_, temporary_->name(), AT_SYMLINK_FOLLOW) == 0) return;
    temporary_->is_gone();
    fail();
}

void posix_file::rename(const std::string& otherwise)
{
    if (target_.stream) return;
    if (::renameat(*folder_, temporary_->name(), *folder_, name_.c_str()) != 0)
        cannot_write(target_.path, errno, otherwise);
    temporary_->is_gone();
    temporary_.reset();
}

void posix_file::sync_folder()
{
    if (target_.stream) return;
    if (const descriptor folder(::openat(*folder_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)); folder) ::fsync(*folder);
}

void posix_file::require_writable(const file_target& target)
{
    if (target.number >= 0)
    {
        const int flags = ::fcntl(target.number, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) cannot_write(target.path, EBADF);
        return;
    }
    if (target.stream)
    {
        if (::faccessat(AT_FDCWD, target.path.c_str(), W_OK, AT_EACCESS) != 0) cannot_write(target.path, errno);
        return;
    }
    posix_file file(target);
    file.write(std::string(4096, '\0')); // a block: none is left on a full disk
    file.link();
}

void posix_file::open_stream()
{
    file_ = descriptor(target_.number >= 0 ? ::fcntl(target_.number, F_DUPFD_CLOEXEC, 0)
                                           : ::open(target_.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (!file_) fail();
}

void posix_file::create(bool nameless)
{
    const auto folder = target_.path.has_parent_path() ? target_.path.parent_path() : std::filesystem::path(".");
    name_ = target_.path.filename().string();
#ifdef O_PATH
    folder_ = descriptor(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
#else
    folder_ = descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
#endif
    if (!folder_) fail();
    look_at_replaced();
    // Of a file that is replaced, nobody reads what comes who could not read what was there.
    const mode_t mode = replaced_ ? 0600 : 0666;
    if (nameless) create_without_name(mode);
    if (!file_) create_with_name(mode);
}

void posix_file::look_at_replaced()
{
    struct stat old = {}, folder = {};
    if (::fstatat(*folder_, name_.c_str(), &old, AT_SYMLINK_NOFOLLOW) != 0)
    {
        if (errno != ENOENT) fail();
        return;
    }
    replaced_ = old;
    if (::faccessat(*folder_, name_.c_str(), W_OK, AT_EACCESS) != 0) fail();
    // In a folder like /tmp only the owner of a file renames over it.
    const uid_t user = ::geteuid();
    if (::fstat(*folder_, &folder) == 0 && (folder.st_mode & S_ISVTX) != 0 && user != 0 && user != old.st_uid &&
        user != folder.st_uid)
        cannot_write(target_.path, EPERM);
}

void posix_file::create_without_name([[maybe_unused]] mode_t mode)
{
#ifdef O_TMPFILE
    file_ = descriptor(::openat(*folder_, ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, mode));
    // It gets its name through /proc, later.
    if (file_ && ::access(own_path().c_str(), F_OK) != 0) file_ = descriptor();
#endif
}

void posix_file::create_with_name(mode_t mode)
{
    const naming now;
    if (!now) cannot_write(target_.path, ECANCELED);
    temporary_.emplace(*folder_);
    file_ =
        descriptor(::openat(*folder_, temporary_->name(), O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_CLOEXEC, mode));
    if (file_) return;
    temporary_->is_gone();
    fail();
}

void remove_temporaries() noexcept
{
    const int number = errno;
    impl::naming_is_over = true;
    for (int k = 0; k < 200 && impl::being_named > 0; ++k) ::poll(nullptr, 0, 1); // names are given in no time
    for (const auto& place : impl::removable_names)
        if (const int folder = place.folder; folder >= 0) ::unlinkat(folder, place.name.data(), 0);
    errno = number;
}

} // namespace taut::io::impl
