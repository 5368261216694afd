// SPDX-License-Identifier: MIT
#include "mpi/mpi_options.hpp"

#include <cmath>
#include <filesystem>
#include <system_error>

#include <taut/impl/files/volume/formats.hpp>
#include <taut/volume_file.hpp>

#include "shared/choices.hpp"
#include "shared/command_line.hpp"
#include "shared/failure.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"

namespace taut::tools::mpi
{

namespace
{

void declare_solver(const subcommand& app, mpi_options& o)
{
    add_choice<dist::preconditioner>(app, "--preconditioner", o.solver.preconditioner,
                                     {{"boomeramg", dist::preconditioner::boomeramg},
                                      {"gamg", dist::preconditioner::gamg},
                                      {"block-jacobi", dist::preconditioner::block_jacobi}},
                                     "Preconditioner of the Newton systems");
    add_choice<dist::partition>(app, "--partition", o.solver.partition,
                                {{"curve", dist::partition::curve}, {"ptscotch", dist::partition::ptscotch}},
                                "Owners of vertices: ranges of a curve, or parts by PTScotch, with less communication");
    app.add_option("--petsc", o.solver.options,
                   "PETSc options for the preconditioner, in one argument, such as \"-pc_type gamg\"")
        .type_name("OPTIONS");
}

void declare_checkpoint(const subcommand& app, mpi_options& o)
{
    add_output(
        app, "--checkpoint", o.checkpoint, {.made_of = "MESH", .may_be_folder = true},
        "Write the current shape to this mesh, a folder for an OpenFOAM case, from time to time; continue from it "
        "if it exists. Removed once the result is written")
        .type_name("FILE");
    app.add_option("--checkpoint-interval", o.checkpoint_interval, "Seconds between checkpoints")
        .type_name("S")
        .capture_default_str()
        .check(number_that([](double x) { return x >= 1 && std::isfinite(x); }, "must be at least 1"))
        .needs("--checkpoint");
}

/// Options of the serial program that mean nothing here.
void leave_out(const subcommand& app, std::initializer_list<const char*> names)
{
    for (const char* name : names) app.remove(name);
}

void say(const subcommand& app, const std::string& mesh)
{
    app.describe("MESH", mesh);
    app.use_of("--output").may_be_folder = true;
    app.describe("--output",
                 "Mesh to write, in the format of the input: the same file, or pieces, with new coordinates");
    app.footer("exit codes: 0 valid mesh; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
               "  6 not found; 7 proved infeasible; 8 time limit, with the best mesh written;\n"
               "  9 device, MPI or PETSc failed; 130 interrupted, 143 terminated");
}

} // namespace

void require_names(const mpi_options& o, const io::volume_file& input)
{
    require_name(o.shape.output, input);
    if (o.checkpoint.empty()) return;
    require_name(o.checkpoint, input, "--checkpoint");
    std::error_code unknown;
    const bool known = io::impl::volume_format_of_name(o.checkpoint) != io::volume_format::automatic;
    if (!known && !std::filesystem::is_directory(o.checkpoint, unknown)) // of which more is said when it is read
        throw usage_error("--checkpoint " + o.checkpoint +
                          ": the format follows from the name; give it the extension of " + input.format + " files");
}

std::string count_kinds(const std::array<std::int64_t, 8>& kinds)
{
    std::string text;
    for (std::size_t k = 0; k < kinds.size(); ++k)
        if (kinds[k] > 0)
        {
            const auto shape = io::impl::shape_of(static_cast<io::cell_kind>(k));
            text += (text.empty() ? "" : ", ") + count(static_cast<std::uint64_t>(kinds[k]), shape.name, shape.names);
        }
    return text;
}

void declare_deform(const subcommand& app, mpi_options& o)
{
    tools::declare_deform(app, o.shape);
    leave_out(app, {"--picture", "--clip", "--refine", "--refined-map", "--thickness"});
    declare_solver(app, o);
    declare_checkpoint(app, o);
    say(app, meshes);
}

void declare_smooth(const subcommand& app, mpi_options& o)
{
    tools::declare_smooth(app, o.shape);
    leave_out(app, {"--picture", "--clip"});
    declare_solver(app, o);
    declare_checkpoint(app, o);
    say(app, meshes);
}

} // namespace taut::tools::mpi
