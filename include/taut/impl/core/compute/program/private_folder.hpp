// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace taut::impl
{

/// Why a folder is not the user's alone, so that what lies in it may be somebody else's; empty if it is: it belongs to
/// him (or to root), as that does in which it lies, nobody else may write in it, and it is no symbolic link. That in
/// which it lies may be written by everybody if names there are their owners' alone, as in /tmp.
/// closed_to: bits of POSIX, whose permission to write is a fault. Elsewhere a folder has only to be there.
std::string fault_of_folder(const std::filesystem::path& folder, unsigned closed_to = 0022);

/// Makes a folder of the user alone, and those above it that are missing. Returns why it is none, empty if it is.
std::string fault_of_made_folder(const std::filesystem::path& folder);

} // namespace taut::impl
