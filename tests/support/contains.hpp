// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace taut::test
{

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace taut::test
