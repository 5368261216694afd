// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <taut/dist.hpp>

#include "shared/options.hpp"
#include "volume/shape_options.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools::mpi
{

/// Options of `taut-mpi deform` and `taut-mpi smooth`: those of the serial program, and of the linear solver.
struct mpi_options
{
    shape_options shape;
    dist::solver_params solver;
    std::string checkpoint;           ///< a mesh file for the shape so far; empty: none
    double checkpoint_interval = 600; ///< seconds
};

/// Throws usage_error where -o or --checkpoint is named as a file of another format than that of the input, or would
/// overwrite it, or the checkpoint has a name by which no format is known.
void require_names(const mpi_options& o, const io::volume_file& input);

/// What the input may be, for --help.
inline constexpr const char* meshes =
    "Volume or planar mesh: .mesh .msh .vtk .vtu .node .su2; in pieces: .pvtu, or the folder of an OpenFOAM case";

/// "32 tetrahedra, 3 wedges": numbers of cells by cell_kind.
std::string count_kinds(const std::array<std::int64_t, 8>& kinds);

/// Declare the options of either command, without those that are of one process.
void declare_deform(const subcommand& app, mpi_options& options);
void declare_smooth(const subcommand& app, mpi_options& options);

} // namespace taut::tools::mpi
