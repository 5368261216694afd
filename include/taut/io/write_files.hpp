// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <taut/io/atomic_file.hpp>

namespace taut::io
{

/// A file to write, and what writes its bytes.
struct file_to_write
{
    std::filesystem::path path;
    std::function<void(atomic_file&)> write;
};

/// Writes several files that appear together or not at all: all are written in their order, then what are devices and
/// pipes, then the files get their names. Throws io_error; then no file has changed, but for the rare case that the
/// system refuses to rename a finished file, where the message says which files have been replaced.
inline void write_files(std::span<const file_to_write> files)
{
    std::vector<const file_to_write*> order;
    for (const auto& file : files) order.push_back(&file);
    std::stable_partition(order.begin(), order.end(), [](const auto* file) { return !is_stream(file->path); });
    std::deque<atomic_file> open;
    for (const auto* file : order)
    {
        file->write(open.emplace_back(file->path));
        open.back().finish();
    }
    for (auto& file : open) file.link();
    std::string replaced;
    for (std::size_t k = 0; k < open.size(); ++k)
    {
        open[k].rename(replaced.empty() ? "" : "; already replaced: " + replaced);
        replaced += (replaced.empty() ? "" : ", ") + order[k]->path.string();
    }
    for (auto& file : open) file.sync_folder();
}

} // namespace taut::io
