// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#elif defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace taut::io::impl
{

/// A stream of the C library, closed at its end.
using open_file = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// These return null, with errno, if that file cannot be opened. mode: "rb" or "wb".
inline open_file open_name(const std::filesystem::path& path, const char* mode)
{
#if defined(_WIN32)
    return {::_wfopen(path.c_str(), *mode == 'r' ? L"rb" : L"wb"), &std::fclose}; // names of all alphabets
#else
    return {std::fopen(path.string().c_str(), mode), &std::fclose};
#endif
}

/// To be written; fails where there is a file of that name.
inline open_file open_new(const std::filesystem::path& path)
{
#if defined(_WIN32)
    const int number = ::_wopen(path.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
    return {number < 0 ? nullptr : ::_fdopen(number, "wb"), &std::fclose};
#else
    return open_name(path, "wbx");
#endif
}

/// What is open already under that number, read or written on from where it is.
inline open_file open_number([[maybe_unused]] int number, [[maybe_unused]] const char* mode)
{
#if defined(_WIN32)
    ::_setmode(number, _O_BINARY);
    const int copy = ::_dup(number);
    return {copy < 0 ? nullptr : ::_fdopen(copy, mode), &std::fclose};
#elif defined(__unix__) || defined(__APPLE__)
    const int copy = ::dup(number);
    return {copy < 0 ? nullptr : ::fdopen(copy, mode), &std::fclose};
#else
    return {nullptr, &std::fclose};
#endif
}

} // namespace taut::io::impl
