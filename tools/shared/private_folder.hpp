// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include <sys/stat.h>

namespace taut::tools
{

/// Why a folder is not the user's alone, so that what lies in it may be somebody else's; empty if it is: it belongs to
/// him (or to root), as that does in which it lies, nobody else may write in it, and it is no symbolic link.
/// closed_to: whose permission to write is a fault.
std::string fault_of_folder(const std::filesystem::path& folder, mode_t closed_to = S_IWGRP | S_IWOTH);

/// Makes a folder of the user alone, and those above it that are missing. Throws usage_error, which begins with
/// `option`, if it cannot be made, or is there and somebody else's.
void make_private(const std::filesystem::path& folder, const std::string& option);

} // namespace taut::tools
