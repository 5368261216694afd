// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <taut/impl/io/file/file_target.hpp>

#if defined(__unix__) || defined(__APPLE__)
#include <taut/impl/io/file/posix_file.hpp>
#else
#include <taut/impl/io/file/plain_file.hpp>
#endif

namespace taut::io::impl
{

#if defined(__unix__) || defined(__APPLE__)
using new_file = posix_file;
#else
using new_file = plain_file;

/// Does nothing: there is no signal handler on systems without POSIX.
inline void remove_temporaries() noexcept {}
#endif

} // namespace taut::io::impl

namespace taut::io
{

/// Output file that appears complete or not at all: it is written beside the one of that name, which it replaces in
/// commit(). Without commit() nothing is left behind, and an older file stays. Permissions of the older file stay, its
/// other hard links keep the older text, a link is followed. Devices, pipes and /dev/stdout are written directly.
/// All members throw io_error, also where the disk is full.
class atomic_file
{
public:
    explicit atomic_file(const std::filesystem::path& path) : file_(impl::resolve_target(path)) {}

    void write(std::string_view text) { file_.write(text); }

    /// Finishes the file and renames it to its final name.
    void commit()
    {
        finish();
        link();
        rename();
        sync_folder();
    }

    /// Steps of commit(), for several files that are to appear together: flush to the disk; link to a hidden name, if
    /// it has none; rename. otherwise: added to the message if that fails.
    void finish() { file_.finish(); }
    void link() { file_.link(); }
    void rename(const std::string& otherwise = {}) { file_.rename(otherwise); }
    void sync_folder() { file_.sync_folder(); }

private:
    impl::new_file file_;
};

} // namespace taut::io

namespace taut::io::impl
{

/// Returns whether a path is written directly: a device, a pipe, an open file such as /dev/stdout. Throws io_error for
/// a folder.
inline bool is_stream(const std::filesystem::path& path)
{
    return impl::resolve_target(path).stream;
}

/// Checks that a file can be written: permission, folder, room. Changes nothing. Throws io_error.
inline void require_writable(const std::filesystem::path& path)
{
    impl::new_file::require_writable(impl::resolve_target(path));
}

} // namespace taut::io::impl

namespace taut::io
{

/// Writes a file as a whole. Throws io_error.
inline void write_file(const std::filesystem::path& path, std::string_view bytes)
{
    atomic_file file(path);
    file.write(bytes);
    file.commit();
}

} // namespace taut::io
