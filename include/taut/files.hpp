// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_FILE
#endif
#ifndef TAUT_FILES_HPP
#define TAUT_FILES_HPP

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <taut/impl/files/file/atomic_file.hpp>
#include <taut/impl/files/file/file_target.hpp>

/// Files that are written as a whole or not at all, one or several together.
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

/// Writes a file as a whole. Throws io_error.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// File to be written, with the function that writes its bytes.
struct file_to_write
{
    std::filesystem::path path;
    std::function<void(atomic_file&)> write;
};

/// Writes several files that appear together or not at all: all are written in their order, then what are devices and
/// pipes, then the files get their names. Throws io_error; then no file has changed, but for the rare case that the
/// system refuses to rename a finished file, where the message says which files have been replaced.
void write_files(std::span<const file_to_write> files);

} // namespace taut::io

#endif
#include <taut/impl/leave.inl>
