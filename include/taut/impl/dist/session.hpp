// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include <mpi.h>

#include <taut/impl/core/observer.hpp>
#include <taut/impl/dist/constraints.hpp>
#include <taut/impl/dist/deform_params.hpp>
#include <taut/impl/dist/report.hpp>
#include <taut/impl/processes/mesh_piece.hpp>

namespace taut::dist::impl
{

template <class Element>
class shape_body;

} // namespace taut::dist::impl

namespace taut::dist
{

/// Result of deform() and session::solve(): positions and a report; `auto [x, report] = ...`.
template <class Element>
struct result
{
    std::vector<vec<Element::dimension>> x; ///< one per vertex of the caller's piece, in its order; empty: none
    dist::report report;

    /// True if there is a shape that is certified.
    explicit operator bool() const { return report.outcome == outcome::valid; }
};

/// Interactive session of one volume, or a mesh of the plane (z = 0), over the processes of a communicator. It keeps
/// the distribution, the tables, the kernels, and, as long as the same coordinates are fixed, the preconditioner: later
/// calls of solve() cost their Newton steps and nothing else.
///
///     taut::dist::session<taut::tetrahedron> s(MPI_COMM_WORLD, piece, {.constraints = pins});
///     auto [x, report] = s.solve();
///     s.constrain(others);
///     s.solve();
///
/// Every function is collective: all processes call it. Where one of them fails, all throw; the others a remote_error.
/// The communicator is duplicated. MPI is initialised by the program; PETSc by the program, or here.
template <class Element>
class session
{
public:
    static constexpr int D = Element::dimension;

    /// Distributes the mesh. Throws mesh_error, parameter_error, constraint_error, no_device, device_error,
    /// backend_error.
    session(MPI_Comm comm, const mesh_piece<Element>& piece, const deform_params<Element>& params = {});
    ~session();
    session(session&&) noexcept;
    session& operator=(session&&) noexcept;

    /// Replaces all constraints. Throws constraint_error, with nothing changed.
    session& constrain(const constraints<Element>& wanted);

    /// Brings pins to their targets and minimises, from the last shape. The first process whose limit is reached or
    /// whose observer refuses ends the call of all.
    result<Element> solve(const run_limits& limits = {});

    /// The state of the session, for tests and measurements.
    impl::shape_body<Element>& body() { return *body_; }

private:
    std::unique_ptr<impl::shape_body<Element>> body_;
};

/// Deforms a volume, or a mesh of the plane, that the processes of a communicator have in pieces, with as little
/// distortion as the energy asks for, so that pins are met bit for bit and no element is inverted: one call of a
/// session. The answer is in the distribution of the piece. Outcomes are those of taut::deform(); infeasible is proved
/// by elements alone whose vertices are all pinned, and a shape to begin with that has inverted elements is gave_up.
/// Collective; throws as session does.
template <class Element>
result<Element> deform(MPI_Comm comm, const mesh_piece<Element>& piece, const deform_params<Element>& params = {},
                       const run_limits& limits = {})
{
    return session<Element>(comm, piece, params).solve(limits);
}

} // namespace taut::dist
