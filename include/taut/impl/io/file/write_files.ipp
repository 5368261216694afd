// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <string>
#include <taut/impl/io/write_files.hpp>
#include <vector>

namespace taut::io
{

void write_files(std::span<const file_to_write> files)
{
    std::vector<const file_to_write*> order;
    for (const auto& file : files) order.push_back(&file);
    std::stable_partition(order.begin(), order.end(), [](const auto* file) { return !impl::is_stream(file->path); });
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
