// SPDX-License-Identifier: MIT
// One process fails by itself where others wait for it, inside of PETSc or for its numbers: all are ended, with one
// message, within a time. The calls of PETSc that are defined here stand in for its own.
#include <cstring>
#include <iostream>
#include <new>
#include <string>

#include <dlfcn.h>
#include <unistd.h>

#include <petscksp.h>

#include <dist/pieces.hpp>

namespace
{

std::string fault;
int calls = 0;

/// Whether this call is the one that fails: the k-th of the last process.
bool fails(const char* of, int k)
{
    return fault == of && taut::test::rank_of() == taut::test::size_of() - 1 && ++calls == k;
}

template <class F>
F* next(const char* name)
{
    return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" PetscErrorCode PCApply(PC pc, Vec x, Vec y)
{
    if (fails("apply", 3)) return PETSC_ERR_LIB;
    static auto* const real = next<PetscErrorCode(PC, Vec, Vec)>("PCApply");
    return real(pc, x, y);
}

extern "C" PetscErrorCode PCSetUp(PC pc)
{
    if (fails("setup", 3)) return PETSC_ERR_LIB;
    static auto* const real = next<PetscErrorCode(PC)>("PCSetUp");
    return real(pc);
}

extern "C" PetscErrorCode MatUpdateMPIAIJWithArray(Mat A, const PetscScalar v[])
{
    if (fails("memory", 1)) throw std::bad_alloc();
    static auto* const real = next<PetscErrorCode(Mat, const PetscScalar[])>("MatUpdateMPIAIJWithArray");
    return real(A, v);
}

int main(int argc, char** argv)
{
    using namespace taut::test;
    MPI_Init(&argc, &argv);
    fault = argc > 1 ? argv[1] : "";
    ::setenv("TAUT_MPI_PATIENCE", "0.5", 1);
    const auto m = bar(3);
    try
    {
        const taut::dist::deform_params<taut::tetrahedron> how{.constraints = ends(MPI_COMM_WORLD, m, stretched)};
        taut::dist::deform<taut::tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m), how);
        if (rank_of() == 0) std::cout << "nothing failed" << std::endl;
    }
    catch (const taut::error& e)
    {
        std::cout << "told process " << rank_of() << ": " << e.what() << std::endl;
    }
    MPI_Finalize();
    return 0;
}
