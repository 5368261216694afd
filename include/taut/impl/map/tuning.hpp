// SPDX-License-Identifier: MIT
#pragma once

namespace taut::impl
{

/// Numbers of parameterize() that no user has a reason to set.
struct map_tuning
{
    /// As barycentric_params::stretch_rounds, of start_method::barycentric.
    int stretch_rounds = 10;
};

} // namespace taut::impl
