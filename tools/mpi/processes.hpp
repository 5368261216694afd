// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/queue.hpp>

namespace taut::tools::mpi
{

/// Shares the cores of a machine among its processes, unless the environment says otherwise: threads of the library, of
/// PoCL and of OpenMP; and gives each a folder for compiled kernels, as PoCL's is not safe between processes. To be
/// called before there is a device. Collective.
void share_machine(const dist::impl::communicator& all);

/// The queue of this process; device: as --device says, or empty. Throws no_device. Collective.
queue own_queue(const dist::impl::communicator& all, const std::string& device);

} // namespace taut::tools::mpi
