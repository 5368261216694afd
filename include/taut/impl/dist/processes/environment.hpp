// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <petscksp.h>
#include <petscsf.h>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/mesh_piece.hpp>

namespace taut::dist::impl
{

/// Throws backend_error for a code of PETSc other than success.
inline void require(PetscErrorCode code)
{
    if (code == 0) return;
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw backend_error("PETSc: error " + std::to_string(code) + (text ? std::string(": ") + text : std::string()));
}

/// Initialises PETSc, if the program has not, and has its errors returned within a scope. PETSc that is initialised
/// here is finalised with MPI.
class petsc_scope
{
public:
    petsc_scope()
    {
        PetscBool ready = PETSC_FALSE;
        require(PetscInitialized(&ready));
        if (!ready) initialise();
        require(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
    }
    petsc_scope(const petsc_scope&) = delete;
    petsc_scope& operator=(const petsc_scope&) = delete;
    ~petsc_scope() { PetscPopErrorHandler(); }

private:
    /// By each process alone: others need not take part, or have done so on another mesh.
    static void initialise()
    {
        MPI_Comm self = MPI_COMM_NULL;
        communicator::require(MPI_Comm_dup(MPI_COMM_SELF, &self), "MPI_Comm_dup");
        PETSC_COMM_WORLD = self;
        require(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"));
        // As by the command line, without the .petscrc of the folder in which it is called, which may name libraries.
        static char program[] = "taut", alone[] = "-skip_petscrc";
        static char* list[] = {program, alone, nullptr};
        static char** arguments = list;
        static int count = 2;
        require(PetscInitialize(&count, &arguments, nullptr, nullptr));
        int key = MPI_KEYVAL_INVALID;
        const auto finalise = [](MPI_Comm, int, void*, void*)
        {
            PetscBool over = PETSC_FALSE;
            PetscFinalized(&over);
            if (!over) PetscFinalize();
            return MPI_SUCCESS;
        };
        communicator::require(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, finalise, &key, nullptr),
                              "MPI_Comm_create_keyval");
        communicator::require(MPI_Comm_set_attr(MPI_COMM_SELF, key, nullptr), "MPI_Comm_set_attr");
    }
};

} // namespace taut::dist::impl
