// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <system_error>

namespace taut::test
{

/// An empty folder that is removed with all it holds.
class temporary_folder
{
public:
    temporary_folder()
        : path_(std::filesystem::temp_directory_path() / ("taut-test-" + std::to_string(std::random_device{}())))
    {
        std::filesystem::create_directory(path_);
    }
    ~temporary_folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    /// Number of entries, whatever their names.
    std::size_t entries() const
    {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
    }

    static void write(const std::filesystem::path& file, const std::string& bytes)
    {
        std::ofstream(file, std::ios::binary) << bytes;
    }
    static std::string read(const std::filesystem::path& file)
    {
        std::ostringstream bytes;
        bytes << std::ifstream(file, std::ios::binary).rdbuf();
        return bytes.str();
    }

private:
    std::filesystem::path path_;
};

/// A symbolic link. Returns whether the system has them.
inline bool make_link(const std::filesystem::path& target, const std::filesystem::path& name)
{
    std::error_code failure;
    std::filesystem::create_symlink(target, name, failure);
    if (failure && failure != std::errc::function_not_supported)
        throw std::filesystem::filesystem_error("no link", target, name, failure);
    return !failure;
}

} // namespace taut::test
