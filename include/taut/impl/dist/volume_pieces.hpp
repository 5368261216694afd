// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <mpi.h>

#include <taut/impl/core/observer.hpp>
#include <taut/impl/dist/session.hpp>

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
