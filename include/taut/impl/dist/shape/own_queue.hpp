// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdlib>
#include <vector>

#include <mpi.h>

#include <taut/impl/core/compute/choose_device.hpp>
#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/queue.hpp>

namespace taut::dist::impl
{

/// The number of a process among those of its machine, and how many they are.
struct local_rank
{
    int rank = 0, size = 1;
};

/// Collective.
inline local_rank rank_on_machine(const communicator& all)
{
    MPI_Comm here = MPI_COMM_NULL;
    communicator::require(MPI_Comm_split_type(all.raw(), MPI_COMM_TYPE_SHARED, all.rank(), MPI_INFO_NULL, &here),
                          "MPI_Comm_split_type");
    local_rank r;
    MPI_Comm_rank(here, &r.rank);
    MPI_Comm_size(here, &r.size);
    MPI_Comm_free(&here);
    return r;
}

/// Opens the queue of a process: on the device of TAUT_DEVICE, or, where the best device is a GPU, on the next of those
/// that are like it. Throws no_device.
inline queue open_own_queue(const local_rank& here)
{
    const device best = find_device();
    const char* wish = std::getenv("TAUT_DEVICE");
    if ((wish && *wish) || !best.is_gpu()) return queue(best);
    std::vector<device> like;
    for (const auto& d : devices())
        if (d.refusal.empty() && d.device.is_gpu() && d.device.name() == best.name()) like.push_back(d.device);
    if (like.empty()) return queue(best);
    return queue(like[static_cast<std::size_t>(here.rank) % like.size()]);
}

} // namespace taut::dist::impl
