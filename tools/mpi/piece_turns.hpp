// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace taut::tools::mpi
{

/// A .pvtu that is written again and again, each time with pieces of another folder beside it, NAME.taut-0 and
/// NAME.taut-1 in turn: the file that names them is replaced once all are there, so that whatever ends a run it names
/// pieces of one time.
class piece_turns
{
public:
    explicit piece_turns(std::filesystem::path pvtu) : path_(std::move(pvtu)) {}

    /// Both names that it may be written to.
    std::array<std::filesystem::path, 2> turns() const;

    /// That to write next.
    std::filesystem::path next() const;

    /// Gives that file the name; the pieces that had been named before are removed. Throws io_error.
    void replace(const std::filesystem::path& made) const;

    /// Removes the file and its pieces.
    void remove() const;

private:
    /// The pieces that it names now, in folders of its turns: others are not of its making.
    std::vector<std::filesystem::path> pieces() const;

    std::filesystem::path path_;
};

/// Removes files, as a run that was killed may have left them, and their folders where nothing is left in them.
void remove_files(const std::vector<std::string>& files);

} // namespace taut::tools::mpi
