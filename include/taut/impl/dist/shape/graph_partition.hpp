// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include <petscmat.h>

#include <taut/errors.hpp>
#include <taut/impl/dist/processes/environment.hpp>
#include <taut/impl/dist/processes/part.hpp>
#include <taut/impl/dist/shape/free_rows.hpp>

namespace taut::dist::impl
{

/// Pairs of an owned vertex and another one of its cells, by number, sorted.
template <class Element>
std::vector<std::pair<std::int64_t, std::int64_t>> edges_of(const part<Element>& p)
{
    std::vector<std::pair<std::int64_t, std::int64_t>> edges;
    for (const auto& cell : p.corners)
        for (const idx v : cell)
            for (const idx w : cell)
                if (v != w && p.owns(v))
                    edges.emplace_back(p.numbers[static_cast<std::size_t>(v)], p.numbers[static_cast<std::size_t>(w)]);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

/// Collective. The processes that the owned vertices of a part go to, by PTScotch, which cuts few edges. Throws
/// parameter_error where PETSc lacks it.
template <class Element>
std::vector<std::size_t> scotch_owners(const part<Element>& p)
{
    // Threads of its own would call MPI, which need not have been initialised for that.
    setenv("SCOTCH_PTHREAD_NUMBER", "1", 0);
    const auto edges = edges_of(p);
    PetscInt *begin = nullptr, *ends = nullptr; // the matrix frees them
    require(PetscMalloc1(p.own + 1, &begin));
    require(PetscMalloc1(edges.size(), &ends));
    std::fill_n(begin, p.own + 1, PetscInt{0});
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
        ++begin[edges[e].first - p.first() + 1];
        ends[e] = static_cast<PetscInt>(edges[e].second);
    }
    for (std::size_t v = 0; v < p.own; ++v) begin[v + 1] += begin[v];
    Mat adjacency = nullptr;
    require(MatCreateMPIAdj(p.all.raw(), static_cast<PetscInt>(p.own), static_cast<PetscInt>(p.vertices), begin, ends,
                            nullptr, &adjacency));
    const petsc_matrix graph(adjacency);
    MatPartitioning made = nullptr;
    require(MatPartitioningCreate(p.all.raw(), &made));
    const petsc_object<MatPartitioning, MatPartitioningDestroy> cut(made);
    require(MatPartitioningSetAdjacency(made, adjacency));
    if (MatPartitioningSetType(made, MATPARTITIONINGPTSCOTCH) != 0)
        throw parameter_error("solver.partition", "this PETSc has no PTScotch; leave it at the curve");
    IS processes = nullptr;
    require(MatPartitioningApply(made, &processes));
    const petsc_object<IS, ISDestroy> found(processes);
    const PetscInt* values = nullptr;
    require(ISGetIndices(processes, &values));
    std::vector<std::size_t> result(values, values + p.own);
    require(ISRestoreIndices(processes, &values));
    return result;
}

} // namespace taut::dist::impl
