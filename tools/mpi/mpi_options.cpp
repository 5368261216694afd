// SPDX-License-Identifier: MIT
#include "mpi/mpi_options.hpp"

#include "shared/choices.hpp"
#include "shared/command_line.hpp"

namespace taut::tools::mpi
{

namespace
{

void declare_solver(CLI::App& app, mpi_options& o)
{
    add_choice(app, "--preconditioner", o.solver.preconditioner,
               std::vector<choice<dist::preconditioner>>{{"boomeramg", dist::preconditioner::boomeramg},
                                                         {"gamg", dist::preconditioner::gamg},
                                                         {"block-jacobi", dist::preconditioner::block_jacobi}},
               "Preconditioner of the Newton systems");
    app.add_option("--petsc", o.solver.options,
                   "Options of PETSc for the preconditioner, in one argument, as \"-pc_type gamg\"")
        ->type_name("OPTIONS");
}

/// Options of the serial program that mean nothing here.
void leave_out(CLI::App& app, std::initializer_list<const char*> names)
{
    for (const char* name : names)
    {
        auto* const option = app.get_option_no_throw(name);
        if (option == nullptr) continue;
        dynamic_cast<command_line&>(*app.get_parent()).files.erase(option);
        app.remove_option(option);
    }
}

} // namespace

void declare_deform(CLI::App& app, mpi_options& o)
{
    tools::declare_deform(app, o.shape);
    leave_out(app, {"--picture", "--cut", "--refine", "--refined-map", "--thickness"});
    declare_solver(app, o);
}

void declare_smooth(CLI::App& app, mpi_options& o)
{
    tools::declare_smooth(app, o.shape);
    leave_out(app, {"--picture", "--cut", "--interfaces"});
    declare_solver(app, o);
}

} // namespace taut::tools::mpi
