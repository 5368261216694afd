// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

namespace taut
{

/// Reasons why charts cannot be packed. The comment says what packing_error::ids() holds.
enum class packing_fault
{
    not_finite,   ///< the first such vertex
    no_triangle,  ///< the charts without one
    out_of_range, ///< the first triangle with a vertex that is not one of its chart
    no_area,      ///< no ids: the charts have no area that a scale could be taken from
    no_room,      ///< no ids: the padding alone, or what is there already, takes more than the tiles
    pinned        ///< triangles of the surface whose charts cannot stay where they are
};

/// Error of charts that cannot be packed. what() has the reason and the remedy.
class packing_error : public error
{
public:
    packing_error(packing_fault fault, std::vector<idx> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    packing_fault fault() const noexcept { return fault_; }
    const std::vector<idx>& ids() const noexcept { return ids_; }

private:
    packing_fault fault_;
    std::vector<idx> ids_;
};

} // namespace taut
