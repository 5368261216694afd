// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include <taut/core/error.hpp>

namespace taut::view
{

/// A folder of this user alone, for as long as it lives.
class temporary_folder
{
public:
    temporary_folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "taut-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw error("no temporary folder can be made: set TMPDIR");
        path_ = name;
    }
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    ~temporary_folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// The bytes of what write(path) writes.
template <class Write>
std::string written(const Write& write)
{
    const temporary_folder folder;
    const auto path = folder.path() / "out.obj";
    write(path);
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace taut::view
