// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <taut/files.hpp>
#include <taut/impl/dist/ranges/unsuited.hpp>
#include <taut/impl/files/file/atomic_file.hpp>

namespace taut::dist::impl
{

inline constexpr std::size_t most_at_once = std::size_t{1} << 30U; ///< bytes of a call of MPI, whose counts are ints

/// A file that all processes read, each what it wants.
class shared_input
{
public:
    /// Collective. Throws unsuited where a process cannot see the file, or it is none.
    shared_input(const communicator& all, const std::filesystem::path& path)
    {
        std::int64_t bytes = -1;
        std::error_code failure;
        if (std::filesystem::is_regular_file(path, failure) && ::access(path.c_str(), R_OK) == 0)
            bytes = static_cast<std::int64_t>(std::filesystem::file_size(path, failure));
        if (failure) bytes = -1;
        const std::int64_t least = all.least(bytes), most = all.most(bytes);
        if (least < 0 || least != most) throw unsuited("not all processes can read it");
        size = static_cast<std::size_t>(bytes);
        MPI_File opened = MPI_FILE_NULL;
        const bool failed = MPI_File_open(all.raw(), path.c_str(), MPI_MODE_RDONLY, MPI_INFO_NULL, &opened) != 0;
        if (all.any(failed)) throw unsuited("MPI cannot open it");
        file_ = std::shared_ptr<MPI_File>(new MPI_File(opened), close);
    }

    std::size_t size = 0;

    /// Bytes from `begin` on, as many as there are up to `count`.
    std::string bytes(std::size_t begin, std::size_t count) const
    {
        std::string text(std::min(count, size - std::min(size, begin)), '\0');
        for (std::size_t done = 0; done < text.size();)
        {
            const std::size_t n = std::min(most_at_once, text.size() - done);
            MPI_Status status;
            int got = 0;
            if (MPI_File_read_at(*file_, static_cast<MPI_Offset>(begin + done), text.data() + done, static_cast<int>(n),
                                 MPI_BYTE, &status) != 0 ||
                MPI_Get_count(&status, MPI_BYTE, &got) != 0 || got <= 0)
                throw unsuited("MPI cannot read it");
            done += static_cast<std::size_t>(got);
        }
        return text;
    }

private:
    static void close(MPI_File* file)
    {
        int over = 0;
        MPI_Finalized(&over);
        if (!over) MPI_File_close(file);
        delete file;
    }
    std::shared_ptr<MPI_File> file_;
};

/// An output that is complete but for its name.
class pending_output
{
public:
    virtual ~pending_output() = default;

    /// Gives it its name; nothing where that is for another process to do. Throws io_error.
    virtual void commit() = 0;
};

/// A file that all processes write, each its own bytes. It has a hidden name beside its own until commit(), and leaves
/// nothing behind without that; permissions of an older file of its name stay.
class shared_output : public pending_output
{
public:
    /// Collective. Throws io_error.
    shared_output(const communicator& all, const std::filesystem::path& path) : all_(all)
    {
        std::string name;
        all_.together(
            [&]
            {
                if (all_.rank() == 0) name = created(path);
            });
        path_ = all_.shared(name);
        const bool failed =
            MPI_File_open(all_.raw(), path_.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file_) != MPI_SUCCESS;
        const bool any = all_.any(failed);
        if (failed) file_ = MPI_FILE_NULL;
        all_.together(
            [&]
            {
                if (any)
                    throw io::io_error(path.string(), "not all processes can write it; name a folder that all see");
            });
    }
    shared_output(const shared_output&) = delete;
    shared_output& operator=(const shared_output&) = delete;
    ~shared_output() override
    {
        if (file_ != MPI_FILE_NULL) MPI_File_close(&file_);
    }

    /// Puts bytes at a place; an error is told in close().
    void write(std::size_t begin, std::string_view bytes)
    {
        for (std::size_t done = 0; done < bytes.size() && !failed_;)
        {
            const std::size_t n = std::min(most_at_once, bytes.size() - done);
            MPI_Status status;
            int put = 0;
            failed_ = MPI_File_write_at(file_, static_cast<MPI_Offset>(begin + done), bytes.data() + done,
                                        static_cast<int>(n), MPI_BYTE, &status) != MPI_SUCCESS ||
                      MPI_Get_count(&status, MPI_BYTE, &put) != MPI_SUCCESS || put <= 0;
            done += static_cast<std::size_t>(std::max(put, 0));
        }
    }

    /// Collective. All is on the disk. Throws io_error.
    void close()
    {
        failed_ = MPI_File_sync(file_) != MPI_SUCCESS || failed_;
        failed_ = MPI_File_close(&file_) != MPI_SUCCESS || failed_;
        all_.together(
            [this]
            {
                if (failed_) throw io::io_error(named_.string(), "cannot write: the disk may be full");
            });
    }

    /// Gives it its own name: of process 0. Throws io_error.
    void commit() override
    {
        if (!hidden_) return;
        if (::renameat(*folder_, hidden_->name(), *folder_, target_.filename().c_str()) != 0)
            io::impl::cannot_write(named_, errno);
        hidden_->is_gone();
    }

private:
    /// By process 0: the file, empty; its name.
    std::string created(const std::filesystem::path& path)
    {
        named_ = path;
        const auto target = io::impl::resolve_target(path);
        io::impl::new_file::require_writable(target);
        target_ = target.path;
        const auto folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
        folder_ = io::impl::descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        if (!folder_) io::impl::cannot_write(path, errno);
        struct stat old = {};
        const bool replaces = ::fstatat(*folder_, target_.filename().c_str(), &old, 0) == 0;
        hidden_.emplace(*folder_);
        const io::impl::descriptor file(
            ::openat(*folder_, hidden_->name(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, replaces ? 0600 : 0666));
        if (!file)
        {
            hidden_->is_gone();
            io::impl::cannot_write(path, errno);
        }
        if (replaces && ::fchmod(*file, old.st_mode & 0777U) != 0) io::impl::cannot_write(path, errno);
        return (folder / hidden_->name()).string();
    }

    communicator all_;
    std::filesystem::path named_, target_;
    std::string path_;
    io::impl::descriptor folder_;
    std::optional<io::impl::hidden_name> hidden_; ///< of process 0
    MPI_File file_ = MPI_FILE_NULL;
    bool failed_ = false;
};

} // namespace taut::dist::impl
