// SPDX-License-Identifier: MIT
//
// A library to preload (LD_PRELOAD) that makes one call of a program to the file system fail. Only what is done to
// write files of one folder counts.
//
//     TAUT_FAULT=file.write:3  the 3rd write fails; kinds below, 0: none
//     TAUT_FAULT_FOLDER=DIR    that folder
//     TAUT_FAULT_LOG=FILE      gets a line "KIND COUNT" of calls at the end, and "fired" as soon as the fault was made
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

namespace
{

enum kind : std::size_t
{
    opened,
    written,
    flushed,
    linked,
    renamed,
    kinds
};
constexpr const char* names[kinds] = {"file.open", "file.write", "file.flush", "file.link", "file.rename"};

std::array<std::atomic<unsigned long>, kinds> counts{};
std::array<std::atomic<bool>, 1024> watched{}; // file descriptors

template <class F>
F real(const char* name)
{
    return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}

void say(const char* line)
{
    const char* log = std::getenv("TAUT_FAULT_LOG");
    if (!log) return;
    const int file = real<int (*)(const char*, int, ...)>("open")(log, O_WRONLY | O_CREAT | O_APPEND, 0644);
    if (file < 0) return;
    if (real<ssize_t (*)(int, const void*, size_t)>("write")(file, line, std::strlen(line)) < 0) std::abort();
    ::close(file);
}

/// Counts a call; whether it is to fail.
bool fails(kind k, int error)
{
    const unsigned long now = ++counts[k];
    const char* fault = std::getenv("TAUT_FAULT");
    const std::size_t length = std::strlen(names[k]);
    if (!fault || std::strncmp(fault, names[k], length) != 0 || fault[length] != ':') return false;
    if (std::strtoul(fault + length + 1, nullptr, 10) != now) return false;
    say("fired\n");
    errno = error;
    return true;
}

bool in_folder(const char* path)
{
    const char* folder = std::getenv("TAUT_FAULT_FOLDER");
    if (!folder || !path) return false;
    return path[0] != '/' || std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool is_watched(int file)
{
    return file >= 0 && static_cast<std::size_t>(file) < watched.size() && watched[static_cast<std::size_t>(file)];
}

void watch(int file, bool on)
{
    if (file >= 0 && static_cast<std::size_t>(file) < watched.size()) watched[static_cast<std::size_t>(file)] = on;
}

bool for_writing(int flags)
{
    return (flags & (O_WRONLY | O_RDWR)) != 0;
}

__attribute__((destructor)) void write_counts()
{
    char line[64];
    for (std::size_t k = 0; k < kinds; ++k)
    {
        std::snprintf(line, sizeof line, "%s %lu\n", names[k], counts[k].load());
        say(line);
    }
}

int open_by(const char* name, const char* path, int flags, mode_t mode)
{
    const bool counts_here = for_writing(flags) && in_folder(path);
    if (counts_here && fails(opened, EACCES)) return -1;
    const int file = real<int (*)(const char*, int, ...)>(name)(path, flags, mode);
    watch(file, counts_here);
    return file;
}

int open_at_by(const char* name, int folder, const char* path, int flags, mode_t mode)
{
    const bool counts_here = for_writing(flags) && in_folder(path);
    if (counts_here && fails(opened, EACCES)) return -1;
    const int file = real<int (*)(int, const char*, int, ...)>(name)(folder, path, flags, mode);
    watch(file, counts_here);
    return file;
}

std::FILE* fopen_by(const char* name, const char* path, const char* mode)
{
    const bool counts_here = std::strpbrk(mode, "wa+") && in_folder(path);
    if (counts_here && fails(opened, EACCES)) return nullptr;
    std::FILE* file = real<std::FILE* (*)(const char*, const char*)>(name)(path, mode);
    if (file) watch(::fileno(file), counts_here);
    return file;
}

mode_t mode_of(int flags, va_list more)
{
    return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
}

} // namespace

extern "C"
{
    int open(const char* path, int flags, ...)
    {
        va_list more;
        va_start(more, flags);
        const mode_t mode = mode_of(flags, more);
        va_end(more);
        return open_by("open", path, flags, mode);
    }

    int open64(const char* path, int flags, ...)
    {
        va_list more;
        va_start(more, flags);
        const mode_t mode = mode_of(flags, more);
        va_end(more);
        return open_by("open64", path, flags, mode);
    }

    int openat(int folder, const char* path, int flags, ...)
    {
        va_list more;
        va_start(more, flags);
        const mode_t mode = mode_of(flags, more);
        va_end(more);
        return open_at_by("openat", folder, path, flags, mode);
    }

    int openat64(int folder, const char* path, int flags, ...)
    {
        va_list more;
        va_start(more, flags);
        const mode_t mode = mode_of(flags, more);
        va_end(more);
        return open_at_by("openat64", folder, path, flags, mode);
    }

    std::FILE* fopen(const char* path, const char* mode)
    {
        return fopen_by("fopen", path, mode);
    }

    std::FILE* fopen64(const char* path, const char* mode)
    {
        return fopen_by("fopen64", path, mode);
    }

    ssize_t write(int file, const void* data, size_t size)
    {
        if (is_watched(file) && fails(written, ENOSPC)) return -1;
        return real<ssize_t (*)(int, const void*, size_t)>("write")(file, data, size);
    }

    ssize_t writev(int file, const iovec* parts, int count)
    {
        if (is_watched(file) && fails(written, ENOSPC)) return -1;
        return real<ssize_t (*)(int, const iovec*, int)>("writev")(file, parts, count);
    }

    int fsync(int file)
    {
        if (is_watched(file) && fails(flushed, EIO)) return -1;
        return real<int (*)(int)>("fsync")(file);
    }

    int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags)
    {
        if (in_folder(to) && fails(linked, EIO)) return -1;
        return real<int (*)(int, const char*, int, const char*, int)>("linkat")(from_folder, from, to_folder, to,
                                                                                flags);
    }

    int rename(const char* from, const char* to)
    {
        if (in_folder(to) && fails(renamed, EIO)) return -1;
        return real<int (*)(const char*, const char*)>("rename")(from, to);
    }

    int renameat(int from_folder, const char* from, int to_folder, const char* to)
    {
        if (in_folder(to) && fails(renamed, EIO)) return -1;
        return real<int (*)(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder, to);
    }
}
