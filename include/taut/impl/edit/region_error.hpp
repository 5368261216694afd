// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/fault_error.hpp>

namespace taut::impl
{

/// Reasons why a part of a surface is no disk. The comment says what region_error::ids() holds, in numbers of the
/// surface.
struct region_faults
{
    enum fault_kind
    {
        empty,              ///< no triangle; the vertex that was asked for, if there is one
        out_of_range,       ///< vertices or triangles that are not there
        not_a_loop,         ///< vertices of a loop where it leaves the edges, or all where it does not part the surface
        several_components, ///< one triangle of each
        pinched,            ///< vertices where it touches itself
        no_boundary,        ///< no ids: it is the whole surface
        several_boundaries, ///< one vertex of each boundary loop
        handles,            ///< no ids
        flat                ///< no ids: its rim encloses no area, so that its base has no direction
    };
};
using region_fault = region_faults::fault_kind;

} // namespace taut::impl

namespace taut
{

/// Error of a region that cannot be cut out as a disk. what() has the reason and the remedy.
class region_error : public impl::region_faults, public impl::fault_error<impl::region_fault>
{
public:
    using fault_error::fault_error;
};

} // namespace taut
