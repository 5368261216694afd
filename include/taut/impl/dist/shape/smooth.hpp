// SPDX-License-Identifier: MIT
#pragma once

#include <mpi.h>

#include <taut/dist.hpp>

namespace taut::dist::impl
{

/// The session of smooth(), whose solve() it is. Collective.
template <class Element>
session<Element> smoothing_session(MPI_Comm comm, const mesh_piece<Element>& piece, const smooth_params& params);

} // namespace taut::dist::impl
