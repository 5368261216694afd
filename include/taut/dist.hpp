// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mpi.h>

#include <taut/any_energy.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/core/name_in.hpp>
#include <taut/impl/core/solve/stop.hpp>
#include <taut/impl/dist/processes/labelled_face.hpp>
#include <taut/impl/dist/processes/phase_clock.hpp>
#include <taut/mesh_piece.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>
#include <taut/smooth.hpp>
#include <taut/solve_params.hpp>
#include <taut/types.hpp>

/// Deforms and smooths one mesh over many processes. Needs MPI and PETSc (CMake's taut::dist); not part of
/// taut.hpp.
namespace taut::dist
{

/// Preconditioners of the Newton systems, of PETSc.
enum class preconditioner
{
    boomeramg,   ///< algebraic multigrid of hypre, HMIS coarsening: copes with slivers and many processes
    gamg,        ///< smoothed aggregation of PETSc, with the rigid motions as near null space
    block_jacobi ///< inverses of the D x D blocks of the diagonal: for tests, and what is left where the others fail
};

/// Distribution of the vertices over processes.
enum class partition
{
    curve,   ///< ranges of the Morton curve, of equal size
    ptscotch ///< parts of the mesh with few edges between them, by PTScotch of PETSc: half the halo of curved shapes
};

/// Parameters of the linear solver, and of the processes that share its rows.
struct solver_params
{
    dist::preconditioner preconditioner = preconditioner::boomeramg;

    /// Options of PETSc that overrule those of the preconditioner, as `-pc_type gamg -pc_gamg_threshold 0.01`.
    std::string options = {};

    /// Owners of vertices. With PTScotch the last bits of energies depend on the number of processes.
    dist::partition partition = partition::curve;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (preconditioner == dist::preconditioner::block_jacobi && !options.empty())
            throw parameter_error("solver.options", "the block diagonal has none; leave them out");
        const auto word = options.find_first_not_of(" \t");
        if (word != options.npos && options[word] != '-')
            throw parameter_error("solver.options", "'" + options +
                                                        "' begins with no option; options of PETSc begin with -, as in "
                                                        "-pc_type gamg");
    }
};

/// Stable name of a preconditioner.
constexpr const char* to_string(preconditioner p)
{
    return taut::impl::name_in<preconditioner::block_jacobi>({"boomeramg", "gamg", "block-jacobi"}, p);
}

/// Stable name of a partition.
constexpr const char* to_string(partition p)
{
    return taut::impl::name_in<partition::ptscotch>({"curve", "ptscotch"}, p);
}

/// Pins and springs of vertices by the caller's ids, which any process may give: those of all
/// processes together hold. A coordinate may be pinned by several processes, to the same value.
///
///     taut::dist::constraints<taut::tetrahedron> c;
///     c.pin(12, {0, 0, 1}).pin(5, 2, 0.5).spring(40, {1, 0, 0}, 10.0);
template <class Element>
class constraints
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::uint8_t all = taut::impl::fixed_marks<D>::every;

    /// One of them; weight 0: a pin of the coordinates in `held`, else a spring.
    struct entry
    {
        std::int64_t id;
        vec<D> x;
        double weight;
        std::uint8_t held;
    };

    /// Pins a vertex to a position.
    constraints& pin(std::int64_t id, const vec<D>& x)
    {
        entries_.push_back({id, x, 0, all});
        return *this;
    }
    /// Pins coordinate k of a vertex, 0 to D - 1, alone.
    constraints& pin(std::int64_t id, int k, double value)
    {
        vec<D> x(0.0);
        if (k >= 0 && k < D) x[k] = value;
        entries_.push_back({id, x, 0, static_cast<std::uint8_t>(k >= 0 && k < D ? 1U << k : 0U)});
        return *this;
    }
    /// Adds a spring to a position: weight * |x - target|^2 is added to the mean energy. Weight > 0.
    constraints& spring(std::int64_t id, const vec<D>& x, double weight)
    {
        entries_.push_back({id, x, weight, 0});
        return *this;
    }

    bool empty() const { return entries_.empty(); }

    /// Those of this process, as they were given.
    const std::vector<entry>& entries() const { return entries_; }

private:
    std::vector<entry> entries_;
};

/// Parameters of deform() and of sessions over many processes: those of taut::deform_params that are supported. All
/// processes give the same but for `constraints`, `initial` and `queue`.
template <class Element>
struct deform_params
{
    static constexpr int D = Element::dimension;

    /// Energy to be minimised. A user's struct converts, alone or with parameters, as {cloth{}, {0.5}}; so do sums and
    /// products of energies.
    any_energy energy = taut::default_energy();

    /// Weights of elements in the sum: rest measure, as is usual, or all equal.
    energy::weighting weights = energy::weighting::measure;

    /// Pins, which are met bit for bit, and springs; of all processes together.
    dist::constraints<Element> constraints = {};

    /// True if the target shape of elements is a regular one, of the mean size, and the mesh has no rest shape.
    bool regular = false;

    /// Initial shape, if it is not that of the mesh: one position per vertex of the piece. No element is inverted.
    std::vector<vec<D>> initial = {};

    /// Precision; automatic is fp64.
    taut::precision precision = precision::automatic;

    /// Stopping and search of Newton's method.
    solve::params solve = {};

    /// Linear solver.
    solver_params solver = {};

    /// Queue of this process. Without one: processes of a machine take its GPUs in turn, or share its CPU.
    std::optional<taut::queue> queue = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        solver.validate();
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (solve.method != solve::method::automatic && solve.method != solve::method::newton)
            throw parameter_error("solve.method", "must be automatic or newton");
        solve.validate();
        solve.require_newton_search();
    }
};

/// Certificate of a mesh over many processes, as taut::certificate of one; counts in 64 bits.
struct certificate
{
    std::int64_t elements = 0;
    std::int64_t flipped = 0;             ///< elements that are turned over, flat or not finite; exact
    std::vector<std::int64_t> ids;        ///< the first of these, in the order of the caller's cells, by process
    std::int64_t branched = 0;            ///< inner edges (in the plane vertices) that are gone around more than once
    std::vector<std::int64_t> branch_ids; ///< the first of them: the ids of their vertices
    double min_det = 0, max_det = 0;      ///< mapped / rest measure

    explicit operator bool() const { return flipped == 0 && branched == 0; }
};

/// Report of a run over many processes; the same on all of them but for `seconds` and what is said to be of a process.
struct report
{
    taut::outcome outcome = taut::outcome::no_valid_start; ///< valid: there is a certified shape
    std::string reason;             ///< why there is none, or why pins are not at their targets; else empty
    std::vector<std::int64_t> ids;  ///< elements or vertices that the reason concerns
    std::vector<std::string> notes; ///< decisions of the library
    bool converged = false;         ///< pins are met, and the shape is a minimum
    bool stopped = false;           ///< a limit or an observer ended the run
    bool pins_held = false;         ///< all pins are met, bit for bit
    double distance = 0;            ///< of the vertex that is farthest from its pin
    double energy = 0;              ///< mean over the elements, springs included
    double gradient = 0;            ///< its relative norm
    int steps = 0;                  ///< of Newton's method
    int products = 0;               ///< of conjugate gradients, all steps together
    int setups = 0;                 ///< of the preconditioner
    int fallbacks = 0;              ///< how often a safer preconditioner was needed
    std::int64_t unknowns = 0;      ///< vertices that may move
    std::int64_t on_interfaces = 0; ///< vertices inside that smooth() keeps to interfaces
    certificate flips;              ///< of the shape that is returned
    impl::phase_seconds seconds;    ///< of this process
    std::int64_t own_vertices = 0, halo_vertices = 0, local_cells = 0; ///< of this process
    std::uint64_t device_bytes = 0;                                    ///< in buffers of its device
};

} // namespace taut::dist

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
    solver_params solver = {};
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

/// Counts inverted elements, and edges (in the plane vertices) that are gone around more than once, in exact
/// arithmetic, of a mesh that the processes of a communicator have in pieces. Collective. Throws mesh_error,
/// parameter_error for pieces that are no mesh, or have no vertices.
template <class Element>
certificate check(MPI_Comm comm, const mesh_piece<Element>& piece);

} // namespace taut::dist

namespace taut::dist::impl
{

class ranged_volume;

} // namespace taut::dist::impl

namespace taut::dist
{

/// Volume file of tetrahedra that the processes of a communicator read together, each a range of its bytes: .su2,
/// .mesh in double precision and .msh 2.2 and 4.1 of text, with an item a line, TetGen, and .vtu whose arrays are
/// appended raw. Any other file that io::read_volume_file() reads is read by process 0, which deals it out. Every
/// function but piece() and read_whole() is collective.
///
///     taut::dist::volume_pieces wing(MPI_COMM_WORLD, "wing.su2");
///     taut::dist::constraints<taut::tetrahedron> pins;
///     for (const std::int64_t v : wing.members("far")) pins.pin(v, wing.point(v));
///     const auto [x, report] = taut::dist::deform(MPI_COMM_WORLD, wing.piece(), {.constraints = pins});
///     wing.write("moved.su2", x);
class volume_pieces
{
public:
    /// Throws io_error; mesh_error where there are no tetrahedra.
    volume_pieces(MPI_Comm comm, const std::filesystem::path& path);
    ~volume_pieces();
    volume_pieces(volume_pieces&&) noexcept;
    volume_pieces& operator=(volume_pieces&&) noexcept;

    /// Vertices and cells of this process; ids are the places of vertices in the file. Those of the vertices follow
    /// each other, and are of one process each.
    const mesh_piece<tetrahedron>& piece() const;

    /// Position of a vertex of the piece by its id.
    const vec3& point(std::int64_t id) const;

    /// Why process 0 read the file as a whole; empty: it did not.
    const std::string& read_whole() const { return read_whole_; }

    /// Names of the groups of vertices.
    std::vector<std::string> groups() const;

    /// Ids of the vertices of a group that the piece has, ascending. Throws group_error on all processes.
    std::vector<std::int64_t> members(const std::string& group) const;

    /// Writes the file with other coordinates, all else as it was, byte for byte; it appears as a whole or not at all.
    /// x: one per vertex of the piece. Throws io_error, parameter_error.
    void write(const std::filesystem::path& path, const std::vector<vec3>& x) const;

private:
    std::unique_ptr<impl::ranged_volume> volume_;
    std::string read_whole_;
};

/// Deforms the volume of a file and writes the result beside it, if there is one: deform() of its pieces. fixed: names
/// of groups that stay where they are. Ids of constraints are places of vertices in the file. Throws as
/// volume_pieces and session do.
report deform(MPI_Comm comm, const std::filesystem::path& input, const std::filesystem::path& output,
              const deform_params<tetrahedron>& params = {}, const std::vector<std::string>& fixed = {},
              const run_limits& limits = {});

} // namespace taut::dist
