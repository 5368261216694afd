// SPDX-License-Identifier: MIT
#include "mpi/case_folder.hpp"

#include <cstdio>
#include <string>
#include <system_error>

#include <fcntl.h>

#include <taut/impl/io/io_error.hpp>

namespace taut::tools::mpi
{

namespace
{

namespace fs = std::filesystem;

/// Whether a folder has one sub-folder of that name, and nothing else.
bool has_only(const fs::path& folder, const std::string& name)
{
    std::error_code failure;
    bool found = false;
    for (const auto& entry : fs::directory_iterator(folder, failure))
    {
        if (entry.path().filename() != name || !entry.is_directory(failure)) return false;
        found = true;
    }
    return found && !failure;
}

} // namespace

bool same_folder(const fs::path& a, const fs::path& b)
{
    std::error_code unknown;
    const auto spelled = [&](const fs::path& path)
    {
        auto full = fs::weakly_canonical(fs::absolute(path, unknown), unknown);
        return full.has_filename() ? full : full.parent_path(); // as "case/"
    };
    return fs::equivalent(a, b, unknown) || spelled(a) == spelled(b);
}

bool holds_meshes_alone(const fs::path& folder)
{
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure))
    {
        const std::string name = entry.path().filename().string();
        const bool piece = name.starts_with("processor") && has_only(entry.path(), "constant") &&
                           has_only(entry.path() / "constant", "polyMesh");
        if (!piece && !(name == "constant" && has_only(entry.path(), "polyMesh"))) return false;
    }
    return !failure;
}

void remove_folder(const fs::path& folder)
{
    std::error_code failure;
    fs::remove_all(folder, failure);
    if (failure) throw io::io_error(folder.string(), "cannot be removed: " + failure.message());
}

void replace_folder(const fs::path& made, const fs::path& name)
{
#if defined(__linux__)
    if (::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, name.c_str(), RENAME_EXCHANGE) == 0)
    {
        remove_folder(made);
        return;
    }
#endif
    remove_folder(name); // not there, or of a file system that exchanges nothing
    std::error_code failure;
    fs::rename(made, name, failure);
    if (failure) throw io::io_error(name.string(), "cannot get its name: " + failure.message());
}

} // namespace taut::tools::mpi
