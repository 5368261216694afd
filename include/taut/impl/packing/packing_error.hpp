// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/fault_error.hpp>

namespace taut::impl
{

/// Reasons why charts cannot be packed. The comment says what packing_error::ids() holds.
struct packing_faults
{
    enum fault_kind
    {
        not_finite,   ///< the first such vertex
        no_triangle,  ///< the charts without one
        out_of_range, ///< the first triangle with a vertex that is not one of its chart
        no_area,      ///< no ids: the charts have no area that a scale could be taken from
        no_room,      ///< no ids: the padding alone, or what is there already, takes more than the tiles
        pinned        ///< triangles of the surface whose charts cannot stay where they are
    };
};
using packing_fault = packing_faults::fault_kind;

} // namespace taut::impl

namespace taut
{

/// Error of charts that cannot be packed. what() has the reason and the remedy.
class packing_error : public impl::packing_faults, public impl::fault_error<impl::packing_fault>
{
public:
    using fault_error::fault_error;
};

} // namespace taut
