// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/mesh.hpp>

namespace taut::tools
{

/// The index of an array for an id of a mesh.
inline std::size_t at(idx i)
{
    return static_cast<std::size_t>(i);
}

} // namespace taut::tools
