// SPDX-License-Identifier: MIT
#include "shared/file_identity.hpp"

#include <system_error>

#include <taut/impl/files/file/file_target.hpp>

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

/// The file that is written under a name: that of a link, though nothing is there yet.
fs::path target_of(const fs::path& path)
{
    try
    {
        return io::impl::resolve_target(path).path;
    }
    catch (const io::io_error&) // a folder, or links without end
    {
        return path;
    }
}

} // namespace

file_identity::file_identity(const fs::path& path)
{
    std::error_code ignored;
    const auto full = fs::weakly_canonical(fs::absolute(target_of(path), ignored), ignored);
    spelled_ = (full.empty() ? path : full).string();
#if !defined(_WIN32) // no numbers of files there; links are followed above
    struct stat found = {};
    if (::stat(path.c_str(), &found) == 0) node_ = node{found.st_dev, found.st_ino};
#endif
}

} // namespace taut::tools
