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

} // namespace taut::tools
