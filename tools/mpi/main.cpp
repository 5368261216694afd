// SPDX-License-Identifier: MIT
// taut-mpi: one volume over many processes. Every process parses the same arguments; the first one prints, reads and
// writes; exit codes are those of `taut`, agreed by all.
#include <chrono>
#include <csignal>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include <mpi.h>

#include <taut/device.hpp>
#include <taut/errors.hpp>
#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/version.hpp>

#include "commands.hpp"
#include "mpi/mpi_check.hpp"
#include "mpi/mpi_shape.hpp"
#include "mpi/processes.hpp"
#include "shared/command_line.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/outputs.hpp"
#include "shared/printable.hpp"
#include "shared/writing.hpp"

namespace taut::tools::mpi
{

namespace
{

using dist::impl::communicator;

/// How a process ended, by itself.
struct ending
{
    exit_code code = exit_code::valid;
    std::string message = {}; ///< empty: none
    bool elsewhere = false;   ///< it was another process that failed
};

constexpr int internal_error = 1;

ending ended(const std::function<exit_code()>& body)
{
    const auto fail = [](exit_code code, const std::string& what) { return ending{code, what}; };
    try
    {
        return {body()};
    }
    catch (const dist::remote_error& e)
    {
        return {exit_code::valid, e.what(), true};
    }
    catch (const usage_error& e)
    {
        return fail(exit_code::usage, e.what());
    }
    catch (const output_error& e)
    {
        return fail(exit_code::usage, e.what());
    }
    catch (const no_valid_map& e)
    {
        return fail(exit_code::no_valid_map, std::string("no valid map; ") + e.what());
    }
    catch (const infeasible_problem& e)
    {
        return fail(exit_code::infeasible, std::string("infeasible; ") + e.what());
    }
    catch (const interrupted_run& e)
    {
        return fail(interruption(), std::string("interrupted; ") + e.what());
    }
    catch (const size_error& e)
    {
        return fail(exit_code::unsuitable_input, e.what());
    }
    catch (const parameter_error& e)
    {
        return fail(exit_code::usage, e.what());
    }
    catch (const no_device& e)
    {
        return fail(exit_code::no_device, e.what());
    }
    catch (const device_error& e)
    {
        return fail(exit_code::device_failure, e.what());
    }
    catch (const dist::backend_error& e)
    {
        return fail(exit_code::device_failure, e.what());
    }
    catch (const io::io_error& e)
    {
        return fail(exit_code::unreadable_input, e.what());
    }
    catch (const mesh_error& e)
    {
        return fail(code_of(e.fault()), e.what());
    }
    catch (const error& e)
    {
        return fail(exit_code::unsuitable_input, e.what());
    }
    catch (const std::bad_alloc&)
    {
        return fail(exit_code::unsuitable_input, "not enough memory for this input; use more processes");
    }
    catch (const std::exception& e)
    {
        return fail(static_cast<exit_code>(internal_error), std::string("internal error: ") + e.what());
    }
}

/// Whether all processes come here within a while: where one failed alone, others may wait for it elsewhere for ever.
bool all_are_here(const communicator& all)
{
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(all.raw(), &request);
    const auto begin = std::chrono::steady_clock::now();
    for (int done = 0;;)
    {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done) return true;
        if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(20)) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void print(const std::string& message)
{
    std::cerr << "taut-mpi: error: " << printable(message) << std::endl;
}

/// One message and one code for all: those of the first process that failed by itself.
int agreed(const communicator& all, const ending& mine)
{
    if (!mine.message.empty() && !all_are_here(all))
    {
        print(mine.message);
        MPI_Abort(all.raw(), to_int(mine.code));
    }
    if (mine.message.empty()) all_are_here(all);
    const bool failed = !mine.message.empty() && !mine.elsewhere;
    const auto who = static_cast<int>(all.least(std::int64_t{failed ? all.rank() : all.size()}));
    if (who == all.size()) return static_cast<int>(all.most(std::int64_t{to_int(mine.code)}));
    const int code = all.shared(to_int(mine.code), who);
    const std::string message = all.shared(mine.message, who);
    if (all.rank() == 0) print(message);
    return code;
}

/// What a command does, given the place of its report.
using collective = std::function<exit_code(const communicator&, const char*)>;

std::function<exit_code()> of_parsed(const communicator& all, const subcommand& app, const collective& body)
{
    return [&all, app, body]
    {
        const char* place = nullptr;
        all.together(
            [&]
            {
                if (all.rank() == 0) place = outputs(files_of(app)).place_of_report();
            });
        return body(all, place);
    };
}

/// Of process 0 alone.
ending described(const communicator& all, const subcommand& app, const tools::command& words)
{
    return ended(
        [&]
        {
            all.together(
                [&]
                {
                    if (all.rank() == 0) words(outputs(files_of(app)));
                });
            return exit_code::valid;
        });
}

/// Of process 0 alone.
exit_code printed(const communicator& all, const std::string& text)
{
    all.together(
        [&]
        {
            if (all.rank() == 0) write_standard_output(text);
        });
    return exit_code::valid;
}

ending run_program(const communicator& all, int argc, char** argv, std::chrono::steady_clock::time_point launch)
{
    command_line program(
        {.name = "taut-mpi",
         .description = "One volume over many processes: what `taut` does, under mpirun.",
         .version = "taut-mpi " TAUT_VERSION_STRING,
         .footer = "exit codes: 0 valid mesh; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
                   "  6 none was found; 7 proved infeasible; 8 time limit, with the best mesh written; 9 device, MPI "
                   "or PETSc failed;\n"
                   "  130 interrupted (Ctrl-C), 143 terminated, with the best mesh written if there was one"});
    mpi_options deforming, smoothing;
    mpi_check_options checking;
    const auto deform = program.add_subcommand("deform", "Deform a volume under fixed and moved vertices");
    declare_deform(deform, deforming);
    const auto smooth = program.add_subcommand("smooth", "Smooth a mesh: move vertices to improve its elements");
    declare_smooth(smooth, smoothing);
    const auto check = program.add_subcommand("check", "Certify that no tetrahedron of a volume is inverted");
    declare_check(check, checking);
    const auto complete = add_completion(program), man = add_man(program);
    try
    {
        const auto note = [&](const std::string& text)
        {
            if (all.rank() == 0) std::cerr << "taut-mpi: note: " << printable(text) << std::endl;
        };
        if (const auto text = program.parse(argc, argv, note))
        {
            return ended([&] { return printed(all, *text); });
        }
    }
    catch (const argument_error& e)
    {
        return {exit_code::usage, std::string(e.what()) + "; " + e.remedy()};
    }
    for (const auto& app : program.subcommands())
    {
        if (!app.parsed()) continue;
        if (app.name() == "completion") return described(all, app, complete);
        if (app.name() == "man") return described(all, app, man);
    }
    const auto shape = [launch](const mpi_options& o)
    {
        return [launch, &o](const communicator& c, const char* place)
        { return run_shape(c, o, o.shape.quiet ? nullptr : place, launch); };
    };
    if (deform.parsed()) return ended(of_parsed(all, deform, shape(deforming)));
    if (smooth.parsed()) return ended(of_parsed(all, smooth, shape(smoothing)));
    return ended(of_parsed(all, check, [&](const communicator& c, const char*) { return run_check(c, checking); }));
}

} // namespace

} // namespace taut::tools::mpi

int main(int argc, char** argv)
{
    const auto launch = std::chrono::steady_clock::now();
    std::signal(SIGPIPE, SIG_IGN);
    taut::tools::watch_interrupts(); // before MPI has threads
    taut::tools::keep(true);         // so that a signal only asks: processes stop together
    MPI_Init(&argc, &argv);
    int code = 0;
    {
        const taut::dist::impl::communicator all(MPI_COMM_WORLD);
        taut::tools::mpi::share_machine(all);
        const auto ending = taut::tools::mpi::run_program(all, argc, argv, launch);
        code = taut::tools::mpi::agreed(all, ending);
    }
    MPI_Finalize();
    return code;
}
