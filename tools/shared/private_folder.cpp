// SPDX-License-Identifier: MIT
#include "shared/private_folder.hpp"

#include <cerrno>
#include <system_error>

#include <unistd.h>

#include "shared/failure.hpp"

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

/// "link/" is what the link leads to, "link" the link.
fs::path without_slash(const fs::path& folder)
{
    const auto plain = folder.lexically_normal();
    return plain.has_filename() ? plain : plain.parent_path();
}

/// 0, or an errno. Folders above are made as well.
int make(const fs::path& folder)
{
    if (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return 0;
    if (errno != ENOENT || !folder.has_parent_path() || folder.parent_path() == folder) return errno;
    if (const int failure = make(folder.parent_path()); failure != 0) return failure;
    return ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST ? 0 : errno;
}

} // namespace

std::string fault_of_folder(const fs::path& folder, mode_t closed_to)
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
    const auto above = fs::weakly_canonical(fs::absolute(plain, failure), failure).parent_path();
    if (::stat(above.c_str(), &state) == 0 && state.st_uid != ::geteuid() && state.st_uid != 0)
        return "lies in a folder of another user, number " + std::to_string(state.st_uid);
    return {};
}

void make_private(const fs::path& folder, const std::string& option)
{
    const int failure = make(without_slash(folder));
    const auto fault = failure != 0 ? std::generic_category().message(failure) : fault_of_folder(folder);
    if (!fault.empty()) throw usage_error(option + ' ' + folder.string() + ": " + fault + "; name another folder");
}

} // namespace taut::tools
