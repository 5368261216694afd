// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/solve/report.hpp>

namespace taut::impl
{

/// Report of one level of a nested iteration.
struct level_report
{
    std::size_t level = 0; ///< 0: the mesh itself
    std::size_t vertices = 0;
    solve::report solve; ///< history left out, but for the finest level
};

} // namespace taut::impl
