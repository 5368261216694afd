// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <taut/impl/io/file/file_target.hpp>

namespace taut::io::impl
{

/// A file descriptor, closed at the end.
class descriptor
{
public:
    explicit descriptor(int number = -1) noexcept : number_(number) {}
    ~descriptor()
    {
        if (number_ >= 0) ::close(number_);
    }
    descriptor(descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    descriptor& operator=(descriptor&& other) noexcept
    {
        std::swap(number_, other.number_);
        return *this;
    }

    explicit operator bool() const noexcept { return number_ >= 0; }
    int operator*() const noexcept { return number_; }

private:
    int number_;
};

/// A name that a signal handler may have to remove.
struct removable_name
{
    static constexpr int free = -1, being_filled = -2;
    std::atomic<int> folder{free}; ///< descriptor
    std::array<char, 32> name{};
};

/// A signal handler reaches nothing but globals. More names than places: what is left over stays after a signal.
inline std::array<removable_name, 64> removable_names;
static_assert(std::atomic<int>::is_always_lock_free); // as handlers demand

/// True once no hidden names may be given any more; and the number of names being given.
inline std::atomic<bool> naming_is_over{false};
inline std::atomic<int> being_named{0};

/// While it lives a file gets its hidden name. Once remove_temporaries() has begun there is no more of that: the
/// program is about to end.
class naming
{
public:
    naming() noexcept
    {
        ++being_named;
        while (naming_is_over && waited_ < 1000) // for the end of the program
        {
            if (waited_++ == 0) --being_named;
            ::poll(nullptr, 0, 1);
        }
    }
    ~naming()
    {
        if (waited_ == 0) --being_named;
    }
    naming(const naming&) = delete;
    naming& operator=(const naming&) = delete;

    /// False where the end has not come: no file gets a name all the same.
    explicit operator bool() const noexcept { return waited_ == 0; }

private:
    int waited_ = 0;
};

/// A random name in a folder for a file that is not finished. Removed at the end unless it was given away.
class hidden_name
{
public:
    explicit hidden_name(int folder) : folder_(folder)
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
    ~hidden_name()
    {
        if (!gone_) ::unlinkat(folder_, name(), 0);
        if (place_) place_->folder = removable_name::free;
    }
    hidden_name(const hidden_name&) = delete;
    hidden_name& operator=(const hidden_name&) = delete;

    const char* name() const noexcept { return name_.data(); }

    /// There is no file of this name, or no longer.
    void is_gone() noexcept { gone_ = true; }

private:
    int folder_;
    std::array<char, 32> name_{};
    removable_name* place_ = nullptr;
    bool gone_ = false;
};

/// File operations of atomic_file by POSIX. The new file has no name while it is written, where the system has such
/// files (Linux), so that nothing can be left of it; else a hidden one.
class posix_file
{
public:
    /// nameless: whether a file without a name is tried.
    explicit posix_file(file_target target, bool nameless = true) : target_(std::move(target))
    {
        if (target_.stream)
            open_stream();
        else
            create(nameless);
    }

    void write(std::string_view text)
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

    /// To the disk, with its final permissions.
    void finish()
    {
        if (target_.stream) return;
        if (replaced_)
        {
            if (::fchown(*file_, replaced_->st_uid, replaced_->st_gid) != 0) errno = 0; // only root gives files away
            if (::fchmod(*file_, replaced_->st_mode & 0777u) != 0) fail();
        }
        if (::fsync(*file_) != 0 && errno != EINVAL && errno != ENOTSUP) fail();
    }

    /// A hidden name in its folder, if it has none: nothing but rename() is left to do.
    void link()
    {
        if (target_.stream || temporary_) return;
        const naming now;
        if (!now) cannot_write(target_.path, ECANCELED);
        temporary_.emplace(*folder_);
        if (::linkat(AT_FDCWD, own_path().c_str(), *folder_, temporary_->name(), AT_SYMLINK_FOLLOW) == 0) return;
        temporary_->is_gone();
        fail();
    }

    /// otherwise: added to the message if it fails
    void rename(const std::string& otherwise = {})
    {
        if (target_.stream) return;
        if (::renameat(*folder_, temporary_->name(), *folder_, name_.c_str()) != 0)
            cannot_write(target_.path, errno, otherwise);
        temporary_->is_gone();
        temporary_.reset();
    }

    /// The new name to the disk. A system that cannot is none the worse for it.
    void sync_folder()
    {
        if (target_.stream) return;
        if (const descriptor folder(::openat(*folder_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)); folder)
            ::fsync(*folder);
    }

    /// Throws io_error if the target could not be written now. Leaves no trace; a pipe is not opened.
    static void require_writable(const file_target& target)
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

private:
    [[noreturn]] void fail() const { cannot_write(target_.path, errno); }

    void open_stream()
    {
        file_ = descriptor(target_.number >= 0 ? ::fcntl(target_.number, F_DUPFD_CLOEXEC, 0)
                                               : ::open(target_.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
        if (!file_) fail();
    }

    void create(bool nameless)
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

    void look_at_replaced()
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

    void create_without_name([[maybe_unused]] mode_t mode)
    {
#ifdef O_TMPFILE
        file_ = descriptor(::openat(*folder_, ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, mode));
        // It gets its name through /proc, later.
        if (file_ && ::access(own_path().c_str(), F_OK) != 0) file_ = descriptor();
#endif
    }

    std::string own_path() const
    {
        return "/proc/self/fd/" + std::to_string(*file_);
    }

    void create_with_name(mode_t mode)
    {
        const naming now;
        if (!now) cannot_write(target_.path, ECANCELED);
        temporary_.emplace(*folder_);
        file_ = descriptor(
            ::openat(*folder_, temporary_->name(), O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_CLOEXEC, mode));
        if (file_) return;
        temporary_->is_gone();
        fail();
    }

    void await_room() const
    {
        pollfd wait = {*file_, POLLOUT, 0};
        ::poll(&wait, 1, -1);
    }

    file_target target_;
    std::string name_; ///< in its folder
    descriptor folder_, file_;
    std::optional<struct stat> replaced_;
    std::optional<hidden_name> temporary_;
};

/// Removes the unfinished files that have a name, and lets no other get one: for the handler of a signal that ends the
/// program, on a thread that writes no files. Async-signal-safe.
inline void remove_temporaries() noexcept
{
    const int number = errno;
    impl::naming_is_over = true;
    for (int k = 0; k < 200 && impl::being_named > 0; ++k) ::poll(nullptr, 0, 1); // names are given in no time
    for (const auto& place : impl::removable_names)
        if (const int folder = place.folder; folder >= 0) ::unlinkat(folder, place.name.data(), 0);
    errno = number;
}

} // namespace taut::io::impl
