// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include <taut/files.hpp>

namespace taut::io::impl
{

/// A file beside an output that nobody has named, as TetGen's .ele or the .bin of glTF, belongs to the output that is
/// there, or to somebody else. written: the files of the output; parts: those of what is there by its name.
/// Throws io_error where one of `written` is there that is neither the output nor one of `parts`, or is a link out of
/// its folder.
void require_own_parts(const std::filesystem::path& output, std::span<const std::filesystem::path> written,
                       std::span<const std::filesystem::path> parts);

} // namespace taut::io::impl
