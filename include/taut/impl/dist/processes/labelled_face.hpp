// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace taut::dist::impl
{

/// A face (in the plane an edge) with a label.
struct labelled_face
{
    std::array<std::int64_t, 4> vertices{-1, -1, -1, -1}; ///< ids of its corners, around; -1 behind the last
    std::int64_t label = 0;                               ///< 0: none
};

} // namespace taut::dist::impl
