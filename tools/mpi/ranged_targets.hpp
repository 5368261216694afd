// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/dist/ranges/ranged_volume.hpp>

#include "volume/shape_options.hpp"

namespace taut::tools::mpi
{

/// What is held of a volume that was read by ranges.
struct ranged_targets
{
    dist::constraints<tetrahedron> pins;  ///< of this process
    std::vector<std::int64_t> fixed;      ///< vertices of groups that are held, of this process
    std::int64_t pinned = 0, springs = 0; ///< of all processes
    std::vector<std::string> notes;
};

/// Targets by --fix, --move and --pins, as group_targets has them for a file on one process; files of places are read
/// by ranges, too. Throws group_error, usage_error, unsuitable_input, io_error. Collective.
ranged_targets targets_of(const dist::impl::ranged_volume& volume, const shape_options& options);

} // namespace taut::tools::mpi
