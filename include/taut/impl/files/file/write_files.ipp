// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <taut/errors.hpp>
#include <taut/files.hpp>
#include <taut/impl/files/file/atomic_file_bodies.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/file/write_files.hpp>

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

namespace taut::io::impl
{

void require_own_parts(const std::filesystem::path& output, std::span<const std::filesystem::path> written,
                       std::span<const std::filesystem::path> parts)
{
    namespace fs = std::filesystem;
    std::error_code unknown;
    for (const auto& one : written)
    {
        if (one == output || !fs::exists(fs::symlink_status(one, unknown))) continue;
        const auto is_it = [&](const fs::path& part) { return fs::equivalent(part, one, unknown); };
        const bool own = fs::exists(output, unknown) && std::any_of(parts.begin(), parts.end(), is_it);
        if (!own || !path_within(one.parent_path(), one))
            throw io_error(output.string(), one.string() + ", which is written with it, is there already and no part "
                                                           "of it; move it away, or choose another name");
    }
}

} // namespace taut::io::impl

namespace taut::io
{

void write_file(const std::filesystem::path& path, std::string_view bytes)
{
    atomic_file file(path);
    file.write(bytes);
    file.commit();
}

} // namespace taut::io
