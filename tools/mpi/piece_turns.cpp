// SPDX-License-Identifier: MIT
#include "mpi/piece_turns.hpp"

#include <algorithm>
#include <system_error>

#include <taut/errors.hpp>
#include <taut/impl/dist/ranges/pvtu_volume.hpp>

namespace taut::tools::mpi
{

namespace
{

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& pvtu)
{
    return pvtu.parent_path() / pvtu.stem();
}

void remove_all(const std::vector<fs::path>& files)
{
    std::error_code kept;
    for (const auto& file : files) fs::remove(file, kept);
    for (const auto& file : files) fs::remove(file.parent_path(), kept);
}

} // namespace

void remove_files(const std::vector<std::string>& files)
{
    remove_all({files.begin(), files.end()});
}

std::array<fs::path, 2> piece_turns::turns() const
{
    const auto turn = [&](const char* k)
    { return path_.parent_path() / (path_.stem().string() + ".taut-" + k + path_.extension().string()); };
    return {turn("0"), turn("1")};
}

std::vector<fs::path> piece_turns::pieces() const
{
    std::vector<fs::path> own;
    for (const auto& file : dist::impl::pieces_of(path_))
        for (const auto& pvtu : turns())
            if (file.parent_path() == folder_of(pvtu)) own.push_back(file);
    return own;
}

fs::path piece_turns::next() const
{
    const auto now = pieces();
    const auto [first, second] = turns();
    const bool taken = std::any_of(now.begin(), now.end(),
                                   [&, in = folder_of(first)](const auto& file) { return file.parent_path() == in; });
    return taken ? second : first;
}

void piece_turns::replace(const fs::path& made) const
{
    const auto before = pieces();
    std::error_code failure;
    fs::rename(made, path_, failure);
    if (failure) throw io::io_error(path_.string(), "cannot get its name: " + failure.message());
    remove_all(before);
}

void piece_turns::remove() const
{
    const auto last = pieces();
    std::error_code kept;
    fs::remove(path_, kept);
    remove_all(last);
}

} // namespace taut::tools::mpi
