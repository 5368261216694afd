// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <taut/errors.hpp>
#include <taut/types.hpp>

/// The piece of a mesh that one of many processes has. Needs MPI and PETSc, as <taut/dist.hpp>.
namespace taut::dist
{

/// Piece of a mesh that one process has, in any distribution: each cell is in one piece, and each vertex in one at
/// least, with the same position in all. Of the last three fields all processes with cells give the same ones.
template <class Element>
struct mesh_piece
{
    std::vector<std::int64_t> ids; ///< numbers of vertices, from 0, the same on all processes; they may have gaps
    std::vector<vec3> points;      ///< rest positions, one per id
    std::vector<std::array<std::int64_t, static_cast<std::size_t>(Element::corners)>> cells; ///< ids of their corners

    /// Where cells are the simplices at the corners of cells of other kinds, which overlap (as
    /// taut::deform_params::owners): the cell of each, by any numbers of this process; those of one follow each other.
    /// Empty: each is a cell.
    std::vector<std::int64_t> owners = {};
    std::vector<double> weights = {};                ///< factors of cells in the sum of deform(); empty: all 1
    std::vector<mat<Element::dimension>> edges = {}; ///< as taut::deform_params::targets, of `regular` ones
};

/// Error of another process of a communicator. Where one process of a collective call fails, it throws its own error,
/// and all others throw this one, with the same text.
class remote_error : public error
{
public:
    remote_error(int rank, const std::string& what) : error(what), rank_(rank) {}

    /// The process that failed, in the numbers of the communicator.
    int rank() const noexcept { return rank_; }

private:
    int rank_;
};

/// Error of MPI or PETSc, whose text what() has.
class backend_error : public error
{
public:
    using error::error;
};

} // namespace taut::dist
