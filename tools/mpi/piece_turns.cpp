// SPDX-License-Identifier: MIT
#include "mpi/piece_turns.hpp"

#include <algorithm>
#include <system_error>

#include <taut/impl/dist_io/pvtu_volume.hpp>
#include <taut/impl/io/io_error.hpp>

namespace taut::tools::mpi
{

namespace
{

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& pvtu)
{
    return pvtu.parent_path() / pvtu.stem();
}

/// Removes files, and their folders where nothing is left in them.
void remove_files(const std::vector<fs::path>& files)
{
    std::error_code kept;
    for (const auto& file : files) fs::remove(file, kept);
    for (const auto& file : files) fs::remove(file.parent_path(), kept);
}

/// Removes what a run that was killed may have left of a .pvtu and its pieces.
void remove_turn(const fs::path& pvtu)
{
    std::error_code kept;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_of(pvtu), kept))
        if (const auto name = entry.path().filename().string();
            name.starts_with(".taut-") || io::impl::small_extension(name) == ".vtu")
            files.push_back(entry.path());
    remove_files(files);
    fs::remove(pvtu, kept);
    fs::remove(folder_of(pvtu), kept);
}

} // namespace

fs::path piece_turns::turn(int k) const
{
    return path_.parent_path() / (path_.stem().string() + ".taut-" + std::to_string(k) + path_.extension().string());
}

std::vector<fs::path> piece_turns::pieces() const
{
    std::vector<fs::path> own;
    for (const auto& file : dist::impl::pieces_of(path_))
        for (const auto& pvtu : {path_, turn(0), turn(1)})
            if (file.parent_path() == folder_of(pvtu)) own.push_back(file);
    return own;
}

fs::path piece_turns::next() const
{
    const auto now = pieces();
    const auto first = turn(0);
    const bool taken =
        std::any_of(now.begin(), now.end(), [&](const auto& file) { return file.parent_path() == folder_of(first); });
    const auto free = taken ? turn(1) : first;
    remove_turn(free);
    return free;
}

void piece_turns::replace(const fs::path& made) const
{
    const auto before = pieces();
    std::error_code failure;
    fs::rename(made, path_, failure);
    if (failure) throw io::io_error(path_.string(), "cannot get its name: " + failure.message());
    remove_files(before);
}

void piece_turns::remove() const
{
    const auto last = pieces();
    std::error_code kept;
    fs::remove(path_, kept);
    remove_files(last);
    for (int k = 0; k < 2; ++k) remove_turn(turn(k));
}

} // namespace taut::tools::mpi
