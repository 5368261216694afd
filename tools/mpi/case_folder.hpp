// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>

namespace taut::tools::mpi
{

/// Whether two names are of one folder, which need not be there.
bool same_folder(const std::filesystem::path& a, const std::filesystem::path& b);

/// Whether a file or folder, which need not be there, is that folder or would lie in it, by whatever name.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

/// A folder with a case of OpenFOAM that was made to be removed again: it lists its files, so that nothing of anybody
/// else is.
class listed_folder
{
public:
    explicit listed_folder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// What it has, a path from here, that is neither in its list nor a folder of what is; empty: nothing. That is
    /// anything where there is no list.
    std::string stranger() const;

    /// Makes it, with a list of files that it will have, named from it. Throws io_error where it is there already.
    void make(std::span<const std::string> files) const;

    /// Removes the files of its list, and folders in which nothing is left.
    void remove() const;

    /// Gives it a name, as a whole; a listed folder that has it is removed. Throws io_error where another one has it.
    void rename_to(const std::filesystem::path& name) const;

private:
    std::filesystem::path folder_;
};

} // namespace taut::tools::mpi
