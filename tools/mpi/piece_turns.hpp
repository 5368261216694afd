// SPDX-License-Identifier: MIT
#pragma once

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

    /// The .pvtu to write next, to a name of its own; what a run that was killed has left of it is removed.
    std::filesystem::path next() const;

    /// Gives that file the name; the pieces that had been named before are removed. Throws io_error.
    void replace(const std::filesystem::path& made) const;

    /// Removes the file, and pieces of whatever turn.
    void remove() const;

private:
    std::filesystem::path turn(int k) const;
    /// The pieces that it names now, in folders of its own.
    std::vector<std::filesystem::path> pieces() const;

    std::filesystem::path path_;
};

} // namespace taut::tools::mpi
