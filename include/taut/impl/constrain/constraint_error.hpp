// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/mesh/describe.hpp>

namespace taut
{

/// Faults of constraints. The comment says what constraint_error::ids() holds.
enum class constraint_fault
{
    out_of_range,  ///< numbers of vertices that the mesh does not have
    no_coordinate, ///< the vertex whose coordinate does not exist
    not_finite,    ///< vertices with a target that is NaN or infinite
    contradictory, ///< vertices whose coordinate is pinned to two different values
    duplicate,     ///< vertices whose coordinate is pinned twice to one value, or that have a second spring
    idle_spring,   ///< vertices with a spring that are pinned altogether
    bad_weight,    ///< vertices with a spring of negative, infinite or NaN weight
    wrong_count,   ///< no ids: not one position per vertex
    no_position,   ///< no ids: "where it is" has no meaning for a surface in space without a map
    unused_vertex, ///< vertices without a cell
    bad_polygon    ///< no ids: fewer than three corners, a corner that is not finite, or no length
};

/// Stable identifier of a fault, for programs.
constexpr const char* to_string(constraint_fault fault)
{
    switch (fault)
    {
    case constraint_fault::out_of_range:
        return "out_of_range";
    case constraint_fault::no_coordinate:
        return "no_coordinate";
    case constraint_fault::not_finite:
        return "not_finite";
    case constraint_fault::contradictory:
        return "contradictory";
    case constraint_fault::duplicate:
        return "duplicate";
    case constraint_fault::idle_spring:
        return "idle_spring";
    case constraint_fault::bad_weight:
        return "bad_weight";
    case constraint_fault::wrong_count:
        return "wrong_count";
    case constraint_fault::no_position:
        return "no_position";
    case constraint_fault::unused_vertex:
        return "unused_vertex";
    case constraint_fault::bad_polygon:
        return "bad_polygon";
    }
    return "unknown";
}

/// Error of constraints that contradict each other or are given twice. what() names the first ids and the remedy; ids()
/// has all.
class constraint_error : public error
{
public:
    constraint_error(constraint_fault fault, std::vector<idx> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    constraint_fault fault() const noexcept { return fault_; }
    const std::vector<idx>& ids() const noexcept { return ids_; } ///< 0-based vertices

private:
    constraint_fault fault_;
    std::vector<idx> ids_;
};

} // namespace taut

namespace taut::impl
{

/// Throws if there are ids: "2 vertices (4, 7) <what>; <remedy>".
inline void refuse_vertices(constraint_fault fault, std::vector<idx> ids, const std::string& what)
{
    if (ids.empty()) return;
    const std::string message = list_ids("vertex", "vertices", ids) + ' ' + what;
    throw constraint_error(fault, std::move(ids), message);
}

} // namespace taut::impl
