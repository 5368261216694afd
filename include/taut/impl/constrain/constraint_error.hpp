// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/fault_error.hpp>
#include <taut/impl/core/name_in.hpp>
#include <taut/impl/mesh/describe.hpp>

namespace taut::impl
{

/// Faults of constraints. The comment says what constraint_error::ids() holds.
struct constraint_faults
{
    enum fault_kind
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
};
using constraint_fault = constraint_faults::fault_kind;

/// Stable identifier of a fault, for programs.
constexpr const char* to_string(constraint_fault fault)
{
    return taut::impl::name_in<constraint_fault::bad_polygon>(
        {"out_of_range", "no_coordinate", "not_finite", "contradictory", "duplicate", "idle_spring", "bad_weight",
         "wrong_count", "no_position", "unused_vertex", "bad_polygon"},
        fault);
}

} // namespace taut::impl

namespace taut
{

/// Error of constraints that contradict each other or are given twice. what() names the first ids and the remedy; ids()
/// has all.
class constraint_error : public impl::constraint_faults, public impl::fault_error<impl::constraint_fault>
{
public:
    using fault_error::fault_error;
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
