// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace taut::tools::batch
{

/// SHA-256 of a file's bytes, 64 hexadecimal digits, as sha256sum prints it. Nothing for what is no regular file that
/// can be read: a pipe without a writer must not hold anybody up.
std::optional<std::string> content_hash(const std::string& path);

} // namespace taut::tools::batch
