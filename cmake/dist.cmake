# SPDX-License-Identifier: MIT
# taut::dist: one mesh over many processes (taut/dist.hpp), where MPI and PETSc are found; the only part that links them.
option(TAUT_MPI "Build taut::dist, taut-mpi and their tests where MPI and PETSc are found" ON)

set(taut_dist_found FALSE)
if(TAUT_MPI)
    set(MPI_CXX_SKIP_MPICXX TRUE) # its C++ bindings, which are no part of MPI any more
    find_package(MPI QUIET COMPONENTS CXX)
    # Debian keeps several builds of PETSc side by side; PETSC_DIR and PETSC_ARCH name others.
    find_path(TAUT_PETSC_INCLUDE petscksp.h HINTS $ENV{PETSC_DIR}/include $ENV{PETSC_DIR}/$ENV{PETSC_ARCH}/include
              /usr/lib/petsc/include /usr/lib/petscdir/petsc-real/include PATH_SUFFIXES petsc)
    find_path(TAUT_PETSC_CONFIGURED petscconf.h HINTS $ENV{PETSC_DIR}/$ENV{PETSC_ARCH}/include ${TAUT_PETSC_INCLUDE}
              /usr/lib/petscdir/petsc-real/include PATH_SUFFIXES petsc)
    find_library(TAUT_PETSC_LIBRARY NAMES petsc petsc_real HINTS $ENV{PETSC_DIR}/$ENV{PETSC_ARCH}/lib $ENV{PETSC_DIR}/lib
                 /usr/lib/petsc/lib /usr/lib/petscdir/petsc-real/lib)
    if(MPI_CXX_FOUND AND TAUT_PETSC_INCLUDE AND TAUT_PETSC_CONFIGURED AND TAUT_PETSC_LIBRARY)
        set(taut_dist_found TRUE)
    else()
        message(STATUS "MPI and PETSc are not both there, so taut::dist and taut-mpi are left out; scripts/setup installs them")
    endif()
endif()

if(taut_dist_found)
    file(GLOB taut_units ${taut_source_dir}/dist/*.cpp)
    add_library(taut_dist STATIC EXCLUDE_FROM_ALL ${taut_units})
    add_library(taut::dist ALIAS taut_dist)
    target_include_directories(taut_dist SYSTEM PUBLIC ${TAUT_PETSC_INCLUDE} ${TAUT_PETSC_CONFIGURED})
    target_link_libraries(taut_dist PUBLIC taut::files MPI::MPI_CXX ${TAUT_PETSC_LIBRARY})
endif()
