// SPDX-License-Identifier: MIT
#pragma once

#include <mpi.h>

#include <taut/impl/dist/report.hpp>
#include <taut/impl/processes/mesh_piece.hpp>

namespace taut::dist
{

/// Counts inverted elements, and edges (in the plane vertices) that are gone around more than once, in exact
/// arithmetic, of a mesh that the processes of a communicator have in pieces. Collective. Throws mesh_error,
/// parameter_error for pieces that are no mesh, or have no vertices.
template <class Element>
certificate check(MPI_Comm comm, const mesh_piece<Element>& piece);

} // namespace taut::dist
