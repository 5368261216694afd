// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_ERRORS_HPP
#define TAUT_ERRORS_HPP

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/core/name_in.hpp>
#include <taut/types.hpp>

/// Errors. All derive from `error` and carry what they are about: a fault, and the ids of what it concerns. Errors of
/// one subject are declared with it: symmetry_error in <taut/charts.hpp>, region_error and paste_error in
/// <taut/paste.hpp>, repair_error in <taut/repair.hpp>, device_error and build_error in <taut/queue.hpp>.
namespace taut
{

/// Base of every exception that the library throws. Each layer derives its own, with data: mesh_error, io_error,
/// no_device, build_error, ... Numerical stops are results, never exceptions.
class error : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// Error of a parameter outside its domain. field() names it as the user wrote it.
class parameter_error : public error
{
public:
    parameter_error(std::string field, const std::string& remedy);

    const std::string& field() const noexcept { return field_; }

private:
    std::string field_;
};

/// Error of an input with more parts than 32-bit indices can number.
class size_error : public parameter_error
{
public:
    using parameter_error::parameter_error;
};

/// Error of a fault, a value of an enumeration, and of the ids that it concerns, from 0. what() names the first ids and
/// the remedy.
template <class Fault>
class fault_error : public error
{
public:
    using fault_type = Fault;

    fault_error(Fault fault, std::vector<idx> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    Fault fault() const noexcept { return fault_; }
    const std::vector<idx>& ids() const noexcept { return ids_; }

private:
    Fault fault_;
    std::vector<idx> ids_;
};

/// Faults of a mesh. The first five make it unusable and are found by the constructor of mesh; the others are found by
/// check() and validate(). The comment says what mesh_error::ids() holds.
struct mesh_faults
{
    enum fault_kind
    {
        empty,                    ///< no cells; no ids
        too_large,                ///< more vertices or corners than 32-bit numbers can name; no ids
        index_out_of_range,       ///< cell, vertex
        non_finite,               ///< vertices with a NaN or infinite coordinate
        repeated_vertex,          ///< cells that name one vertex twice
        degenerate_cell,          ///< cells that are flat at rest
        inverted_cell,            ///< tetrahedra of negative rest volume
        duplicate_cell,           ///< cells in pairs with the same corners
        inconsistent_orientation, ///< cells in pairs that run along their common facet the same way
        not_orientable,           ///< cells in pairs where no choice of orientation agrees
        non_manifold_facet,       ///< vertices of facets with three or more cells, `dimension` of them a facet
        non_manifold_vertex,      ///< vertices whose cells do not form one fan
        unreferenced_vertex,      ///< vertices without a cell
        several_components,       ///< one vertex of each component
        closed_surface,           ///< no ids
        several_boundaries,       ///< one vertex of each boundary loop
        handles                   ///< no ids
    };
};

/// Fault of a mesh: a constant of mesh_error, such as mesh_error::empty.
using mesh_fault = mesh_faults::fault_kind;

/// Stable identifier of a fault, for programs.
constexpr const char* to_string(mesh_fault fault)
{
    return taut::impl::name_in<mesh_fault::handles>(
        {"empty", "too_large", "index_out_of_range", "non_finite", "repeated_vertex", "degenerate_cell",
         "inverted_cell", "duplicate_cell", "inconsistent_orientation", "not_orientable", "non_manifold_facet",
         "non_manifold_vertex", "unreferenced_vertex", "several_components", "closed_surface", "several_boundaries",
         "handles"},
        fault);
}

/// One fault of a mesh, the ids it concerns, and a sentence with the remedy.
struct mesh_finding
{
    mesh_fault fault;
    std::vector<idx> ids; ///< 0-based; which kind: see mesh_fault
    std::string message;
};

/// Error of a mesh that cannot be used. what() names the first ids and the remedy; ids() has all of them.
class mesh_error : public mesh_faults, public fault_error<mesh_fault>
{
public:
    using fault_error::fault_error;

    // NOLINTNEXTLINE(bugprone-throw-keyword-missing): a base, for clang-tidy 14
    explicit mesh_error(mesh_finding found) : fault_error(found.fault, std::move(found.ids), found.message) {}
};

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

/// Fault of constraints: a constant of constraint_error, such as constraint_error::duplicate.
using constraint_fault = constraint_faults::fault_kind;

/// Stable identifier of a fault, for programs.
constexpr const char* to_string(constraint_fault fault)
{
    return taut::impl::name_in<constraint_fault::bad_polygon>(
        {"out_of_range", "no_coordinate", "not_finite", "contradictory", "duplicate", "idle_spring", "bad_weight",
         "wrong_count", "no_position", "unused_vertex", "bad_polygon"},
        fault);
}

/// Error of constraints that contradict each other or are given twice. what() names the first ids and the remedy; ids()
/// has all.
class constraint_error : public constraint_faults, public fault_error<constraint_fault>
{
public:
    using fault_error::fault_error;
};

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

/// Fault of charts that cannot be packed: a constant of packing_error, such as packing_error::no_room.
using packing_fault = packing_faults::fault_kind;

/// Error of charts that cannot be packed. what() has the reason and the remedy.
class packing_error : public packing_faults, public fault_error<packing_fault>
{
public:
    using fault_error::fault_error;
};

} // namespace taut

namespace taut::io
{

/// Position in a file: a line of a text, counted from 1, or a byte of a binary file, counted from 0.
struct file_place
{
    enum unit
    {
        line,
        byte
    };
    unit counted_in;
    std::size_t number;
};

} // namespace taut::io

namespace taut::io::impl
{

/// "mesh.obj, line 12: " or "mesh.obj: ".
inline std::string place_prefix(const std::string& path, const std::optional<file_place>& place)
{
    if (!place) return path + ": ";
    return path + (place->counted_in == file_place::line ? ", line " : ", byte ") + std::to_string(place->number) +
           ": ";
}

} // namespace taut::io::impl

namespace taut::io
{

/// Error of a file that cannot be read, parsed or written.
class io_error : public error
{
public:
    io_error(std::string path, const std::string& what, std::optional<file_place> place = {})
        : error(impl::place_prefix(path, place) + what), path_(std::move(path)), place_(place)
    {
    }

    const std::string& path() const noexcept { return path_; }
    const std::optional<file_place>& place() const noexcept { return place_; } ///< nothing: the file as a whole

private:
    std::string path_;
    std::optional<file_place> place_;
};

} // namespace taut::io

#endif
#include <taut/impl/leave.inl>
