// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstdlib>
#include <system_error>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <taut/impl/core/compute/program/private_folder.hpp>

namespace taut::impl
{

#if defined(__unix__) || defined(__APPLE__)

/// "link/" is what the link leads to, "link" the link.
inline std::filesystem::path without_slash(const std::filesystem::path& folder)
{
    const auto plain = folder.lexically_normal();
    return plain.has_filename() ? plain : plain.parent_path();
}

/// 0, or an errno. Folders above are made as well.
inline int make_folder(const std::filesystem::path& folder)
{
    if (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return 0;
    if (errno != ENOENT || !folder.has_parent_path() || folder.parent_path() == folder) return errno;
    if (const int failure = make_folder(folder.parent_path()); failure != 0) return failure;
    return ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST ? 0 : errno;
}

/// Who may rename a folder above puts another one in its place. The user's home is where the user chose to be, and who
/// owns "/" may do anything.
inline std::string fault_above(const std::filesystem::path& folder)
{
    const char* const named = std::getenv("HOME");
    std::error_code unknown;
    const auto home = std::filesystem::weakly_canonical(named != nullptr ? named : "", unknown);
    struct stat state = {};
    const uid_t system = ::stat("/", &state) == 0 ? state.st_uid : 0;
    for (auto below = folder; below.has_relative_path() && below != home; below = below.parent_path())
    {
        const auto above = below.parent_path();
        if (::stat(above.c_str(), &state) != 0) return std::generic_category().message(errno);
        if (state.st_uid != ::geteuid() && state.st_uid != 0 && state.st_uid != system)
            return "lies in " + above.string() + ", a folder of another user, number " + std::to_string(state.st_uid);
        if ((state.st_mode & 0002) != 0 && (state.st_mode & S_ISVTX) == 0)
            return "lies in " + above.string() +
                   ", in which everybody may rename it (`chmod o-w` or `chmod +t` ends that)";
    }
    return {};
}

std::string fault_of_folder(const std::filesystem::path& folder, unsigned closed_to)
{
    const auto plain = without_slash(folder);
    struct stat state = {};
    if (::lstat(plain.c_str(), &state) != 0) return std::generic_category().message(errno);
    if (S_ISLNK(state.st_mode)) return "is a symbolic link, which may lead anywhere";
    if (!S_ISDIR(state.st_mode)) return std::generic_category().message(ENOTDIR);
    if (state.st_uid != ::geteuid() && state.st_uid != 0)
        return "belongs to another user, number " + std::to_string(state.st_uid);
    if ((state.st_mode & closed_to) != 0)
        return "others may write in it (`chmod go-w` ends that, if all that lies there is yours)";
    std::error_code failure;
    auto full = std::filesystem::absolute(plain, failure);
    if (!failure) full = std::filesystem::weakly_canonical(full, failure);
    return failure ? failure.message() : fault_above(full);
}

std::string fault_of_made_folder(const std::filesystem::path& folder)
{
    const int failure = make_folder(without_slash(folder));
    return failure != 0 ? std::generic_category().message(failure) : fault_of_folder(folder);
}

#else

std::string fault_of_folder(const std::filesystem::path& folder, unsigned)
{
    std::error_code failure;
    return std::filesystem::is_directory(folder, failure) ? "" : std::generic_category().message(ENOTDIR);
}

std::string fault_of_made_folder(const std::filesystem::path& folder)
{
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    return failure ? failure.message() : fault_of_folder(folder, 0);
}

#endif

} // namespace taut::impl
