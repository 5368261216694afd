// SPDX-License-Identifier: MIT
// Every process runs all tests; a failure of any is the failure of all.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <iostream>
#include <sstream>
#include <string>

#include <mpi.h>

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    doctest::Context context(argc, argv);
    std::ostringstream others;
    if (rank > 0) context.setCout(&others);
    int result = context.run();
    if (result != 0 && rank > 0) std::cerr << "process " << rank << ":\n" << others.str() << '\n';
    MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    MPI_Finalize();
    return result;
}
