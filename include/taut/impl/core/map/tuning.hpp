// SPDX-License-Identifier: MIT
#pragma once

namespace taut::impl
{

/// Numbers of parameterize() that no user has a reason to set.
struct map_tuning
{
    /// As barycentric_params::stretch_rounds, of start_method::barycentric.
    int stretch_rounds = 10;

    /// True if a small map is made on the host, with its border kept apart from the initial map on, which is not
    /// minimised without that first. The energy is the isometric one, and nothing is pinned.
    bool apart = false;
};

} // namespace taut::impl
