// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "solver_run.hpp"

namespace bench
{

/// The usual way, on one thread of the host: projected Newton and SLIM with a supernodal Cholesky factorisation of
/// every matrix (CHOLMOD), from Tutte's map on a circle. None where the build left them out (TAUT_BENCH_PEERS).
std::vector<solver> peer_solvers();

/// The file of the BLAS under CHOLMOD, which decides the peers' speed; sets it to one thread.
std::string peer_blas();

} // namespace bench
