// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace taut::tools
{

/// A folder of the user alone among the temporary ones, for as long as it lives.
class temporary_folder
{
public:
    temporary_folder();
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    ~temporary_folder();

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Removes all folders that live, and lets no other be made or removed: for the end of the program on another thread.
void remove_temporary_folders() noexcept;

} // namespace taut::tools
