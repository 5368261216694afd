// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include <taut/impl/dist/processes/communicator.hpp>

#include "mpi/mpi_options.hpp"
#include "shared/exit_codes.hpp"

namespace taut::tools::mpi
{

/// One run of `taut-mpi deform` or `taut-mpi smooth`, of all processes. place_of_report: null if there is none, of the
/// first process.
exit_code run_shape(const dist::impl::communicator& all, const mpi_options& options, const char* place_of_report,
                    std::chrono::steady_clock::time_point launch);

} // namespace taut::tools::mpi
