// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/device.hpp>
#include <taut/errors.hpp>
#include <taut/surface_file.hpp>
#include <taut/version.hpp>

#include "commands.hpp"
#include "shared/command_line.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/other_way.hpp"
#include "shared/printable.hpp"
#include "shared/standard_streams.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

int fail(exit_code code, const std::string& what, const std::string& remedy = {})
{
    // Errors of devices have several lines: what was seen, or a compiler's log.
    const bool one_line = what.find('\n') == std::string::npos;
    std::cerr << "taut: error: " << printable(what) << (remedy.empty() ? "" : (one_line ? "; " : "\n") + remedy)
              << '\n';
    return to_int(code);
}

/// Describes a parameter_error in terms of the command: by the option that sets it, if one does.
std::string in_words_of(const std::optional<subcommand>& command, const parameter_error& e)
{
    std::string option = "--" + e.field();
    std::replace(option.begin(), option.end(), '_', '-');
    const std::string what = e.what(), begin = "parameter " + e.field();
    if (!what.starts_with(begin)) return what;
    const bool known = command && command->has(option);
    return (known ? option : e.field()) + what.substr(begin.size());
}

/// Runs a subcommand; every exception becomes one line and an exit code, see docs/reference/errors.md.
int guarded(const std::function<exit_code()>& run, const std::optional<subcommand>& command = {})
{
    const std::string name = command ? command->name() : "";
    try
    {
        const exit_code code = run();
        const bool written = code == exit_code::valid || code == exit_code::time_limit;
        return to_int(written && interrupted() ? interruption() : code);
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
        return fail(exit_code::no_valid_map, "no valid map", e.what());
    }
    catch (const interrupted_run& e)
    {
        return fail(interruption(), "interrupted", e.what());
    }
    catch (const infeasible_problem& e)
    {
        return fail(exit_code::infeasible, "infeasible", e.what());
    }
    catch (const size_error& e)
    {
        return fail(exit_code::unsuitable_input, in_words_of(command, e));
    }
    catch (const parameter_error& e)
    {
        return fail(exit_code::usage, in_words_of(command, e));
    }
    catch (const no_device& e)
    {
        return fail(exit_code::no_device, e.what());
    }
    catch (const device_error& e)
    {
        return fail(exit_code::device_failure, e.what(), "`taut devices` lists others, --device chooses one");
    }
    catch (const io::io_error& e)
    {
        return fail(exit_code::unreadable_input, e.what(), other_way(e, name));
    }
    catch (const mesh_error& e)
    {
        return fail(code_of(e.fault()), e.what(), other_way(e.fault(), name));
    }
    catch (const error& e) // unsuitable_input, texcoord_error and what the library may add
    {
        return fail(exit_code::unsuitable_input, e.what());
    }
    catch (const std::bad_alloc&)
    {
        return fail(exit_code::unsuitable_input, "not enough memory for this input");
    }
}

int run(int argc, char** argv, std::chrono::steady_clock::time_point launch)
{
    command_line program(
        {.name = "taut",
         .description = "Injective, low-distortion maps of triangle and tetrahedral meshes, on GPUs and processors.",
         .version = "taut " TAUT_VERSION_STRING,
         .footer = "exit codes: 0 valid map; 2 usage; 3 unreadable input; 4 unsuitable input; 5 no device;\n"
                   "  6 no valid map; 7 proved infeasible; 8 time limit, with a valid map written; 9 device failure;\n"
                   "  10 some jobs of a batch failed;\n"
                   "  130 interrupted (Ctrl-C), 143 terminated, with a valid map written if there was one"});

    const auto commands = add_commands(program, launch);
    try
    {
        if (const auto text = program.parse(
                argc, argv, [](const std::string& note) { std::cerr << "taut: note: " << printable(note) << '\n'; }))
            return guarded(
                [&]
                {
                    write_standard_output(*text);
                    return exit_code::valid;
                });
    }
    catch (const argument_error& e)
    {
        return fail(exit_code::usage, e.what(), e.remedy());
    }
    const auto all = program.subcommands();
    for (std::size_t k = 0; k < all.size(); ++k)
        if (all[k].parsed()) return guarded([&] { return commands[k](outputs(files_of(all[k]))); }, all[k]);
    return to_int(exit_code::usage);
}

} // namespace

} // namespace taut::tools

int main(int argc, char** argv)
{
    const auto launch = std::chrono::steady_clock::now();
    taut::tools::watch_interrupts();
    taut::tools::prepare_streams();
    try
    {
        auto words = taut::tools::words_of(argc, argv);
        std::vector<char*> pointers;
        for (auto& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        return taut::tools::run(static_cast<int>(words.size()), pointers.data(), launch);
    }
    catch (const std::exception& e)
    {
        std::cerr << "taut: internal error: " << taut::tools::printable(e.what()) << '\n';
        return 1;
    }
}
