// SPDX-License-Identifier: MIT
// MPI's profiling interface: these take the place of MPI's functions for all libraries of the program.
#include "mpi/traffic.hpp"

#include <mpi.h>

namespace
{

taut::tools::mpi::traffic sent;

void count(int n, MPI_Datatype type) noexcept
{
    int size = 0;
    PMPI_Type_size(type, &size);
    ++sent.messages;
    sent.bytes += static_cast<std::uint64_t>(n) * static_cast<std::uint64_t>(size);
}

} // namespace

namespace taut::tools::mpi
{

traffic sent_so_far() noexcept
{
    return sent;
}

} // namespace taut::tools::mpi

extern "C"
{
    int MPI_Send(const void* from, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm)
    {
        count(n, type);
        return PMPI_Send(from, n, type, to, tag, comm);
    }
    int MPI_Isend(const void* from, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request)
    {
        count(n, type);
        return PMPI_Isend(from, n, type, to, tag, comm, request);
    }
    int MPI_Start(MPI_Request* request)
    {
        ++sent.messages; // of a persistent request, whose size is not told
        return PMPI_Start(request);
    }
    int MPI_Startall(int n, MPI_Request requests[])
    {
        sent.messages += static_cast<std::uint64_t>(n);
        return PMPI_Startall(n, requests);
    }
    int MPI_Allreduce(const void* from, void* to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
    {
        ++sent.reductions;
        return PMPI_Allreduce(from, to, n, type, op, comm);
    }
    int MPI_Bcast(void* data, int n, MPI_Datatype type, int root, MPI_Comm comm)
    {
        ++sent.exchanges;
        return PMPI_Bcast(data, n, type, root, comm);
    }
    int MPI_Alltoallv(const void* from, const int* counts, const int* places, MPI_Datatype type, void* to,
                      const int* theirs, const int* there, MPI_Datatype other, MPI_Comm comm)
    {
        ++sent.exchanges;
        return PMPI_Alltoallv(from, counts, places, type, to, theirs, there, other, comm);
    }
}
