// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace taut::tools
{

/// Fills `to` with what zlib has packed. Returns whether there are as many bytes.
bool inflate(std::string_view packed, std::string& to);

} // namespace taut::tools
