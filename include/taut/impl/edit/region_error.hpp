// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

namespace taut
{

/// Reasons why a part of a surface is no disk. The comment says what region_error::ids() holds, in numbers of the
/// surface.
enum class region_fault
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

/// Error of a region that cannot be cut out as a disk. what() has the reason and the remedy.
class region_error : public error
{
public:
    region_error(region_fault fault, std::vector<idx> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    region_fault fault() const noexcept { return fault_; }
    const std::vector<idx>& ids() const noexcept { return ids_; }

private:
    region_fault fault_;
    std::vector<idx> ids_;
};

} // namespace taut
