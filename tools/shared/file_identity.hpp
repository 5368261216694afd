// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <filesystem>
#include <optional>
#include <string>

#include <sys/stat.h>

namespace taut::tools
{

/// What tells a file from others, by whatever name and link, looked up once.
class file_identity
{
public:
    explicit file_identity(const std::filesystem::path& path);

    /// One spelling for each file, whether it exists or not.
    const std::string& spelled() const { return spelled_; }

    /// Number of a file that is there.
    struct node
    {
        dev_t device;
        ino_t number;
        auto operator<=>(const node&) const = default;
    };
    /// None on systems without.
    const std::optional<node>& number() const { return node_; }

    bool operator==(const file_identity& other) const
    {
        return (node_ && node_ == other.node_) || spelled_ == other.spelled_;
    }

private:
    std::string spelled_;
    std::optional<node> node_;
};

} // namespace taut::tools
