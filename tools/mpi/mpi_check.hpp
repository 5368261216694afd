// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/dist/processes/communicator.hpp>

#include "shared/exit_codes.hpp"
#include "shared/options.hpp"

namespace taut::tools::mpi
{

/// Options of `taut-mpi check`.
struct mpi_check_options
{
    std::string input;
    bool json = false;
    int zone = 0;
};

void declare_check(const subcommand& app, mpi_check_options& options);

/// Certifies the elements of a volume: 0, or 4 where one is inverted or flat. Of all processes.
exit_code run_check(const dist::impl::communicator& all, const mpi_check_options& options);

} // namespace taut::tools::mpi
