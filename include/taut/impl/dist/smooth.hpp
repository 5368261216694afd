// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <mpi.h>

#include <taut/impl/constrain/smooth_boundary.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/dist/session.hpp>
#include <taut/impl/processes/labelled_face.hpp>

namespace taut::dist
{

/// Parameters of smooth() over many processes, those of taut::smooth_params that are supported. All processes give the
/// same but for `fixed`, `regions`, `faces`, `initial` and `queue`.
struct smooth_params
{
    /// Treatment of the boundary.
    smooth_boundary boundary = smooth_boundary::sliding;

    /// Power of the energy, which is shape distortion: larger ones improve the worst elements first, 1 the mean. 1
    /// to 8.
    int worst_exponent = 2;

    /// Ids of vertices that are fixed, of all processes together.
    std::vector<std::int64_t> fixed = {};

    /// Regions of the cells of the piece, as materials, by any numbers: interfaces between them keep their shape, as
    /// smooth_params::kept of one process: flat pieces slide in their planes, lines where pieces meet or end along
    /// themselves, what is curved stays. Empty: all are of region 0.
    std::vector<std::int64_t> regions = {};

    /// Faces inside and on the boundary, of all processes together, which keep their shape by label alike.
    std::vector<impl::labelled_face> faces = {};

    /// Positions to begin with, if they are not those of the mesh: one per vertex of the piece. No element is inverted.
    std::vector<vec3> initial = {};

    solve::params solve = {.gradient_tolerance = 1e-4};
    impl::solver_params solver = {};
    std::optional<taut::queue> queue = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        solver.validate();
        if (worst_exponent < 1 || worst_exponent > 8) throw parameter_error("worst_exponent", "must be 1 to 8");
    }
};

/// Moves the vertices of a volume, or a mesh of the plane, that the processes have in pieces, to improve the shapes of
/// its elements, without inverting one. Connectivity is kept. A mesh with inverted elements is gave_up. Collective;
/// throws as session does.
template <class Element>
result<Element> smooth(MPI_Comm comm, const mesh_piece<Element>& piece, const smooth_params& params = {},
                       const run_limits& limits = {});

} // namespace taut::dist

namespace taut::dist::impl
{

/// The session of smooth(), whose solve() it is. Collective.
template <class Element>
session<Element> smoothing_session(MPI_Comm comm, const mesh_piece<Element>& piece, const smooth_params& params);

} // namespace taut::dist::impl
