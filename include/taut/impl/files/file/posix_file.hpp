// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <taut/impl/files/file/file_target.hpp>

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
    naming() noexcept;
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
    explicit hidden_name(int folder);
    ~hidden_name();
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
    explicit posix_file(file_target target, bool nameless = true);

    void write(std::string_view text);

    /// To the disk, with its final permissions.
    void finish();

    /// A hidden name in its folder, if it has none: nothing but rename() is left to do.
    void link();

    /// otherwise: added to the message if it fails
    void rename(const std::string& otherwise = {});

    /// The new name to the disk. A system that cannot is none the worse for it.
    void sync_folder();

    /// Throws io_error if the target could not be written now. Leaves no trace; a pipe is not opened.
    static void require_writable(const file_target& target);

private:
    [[noreturn]] void fail() const { cannot_write(target_.path, errno); }

    void open_stream();

    void create(bool nameless);

    void look_at_replaced();

    void create_without_name([[maybe_unused]] mode_t mode);

    std::string own_path() const { return "/proc/self/fd/" + std::to_string(*file_); }

    void create_with_name(mode_t mode);

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
void remove_temporaries() noexcept;

} // namespace taut::io::impl
