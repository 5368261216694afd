// SPDX-License-Identifier: MIT
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <taut/volume_file.hpp>

#include "commands.hpp"
#include "deform/shell_run.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/progress.hpp"
#include "shared/run_clock.hpp"
#include "shared/shared_options.hpp"
#include "untangle/untangle_run.hpp"

namespace taut::tools
{

namespace
{

exit_code run(const untangle_options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
{
    command_run command(options, files, launch);
    command.tell("read");
    untangle_report report;
    const auto untangled =
        [&]<class Element>(untangle_problem<Element> problem, const volume_case<Element>* input = nullptr)
    { return untangle_run<Element>(options, command, std::move(report), input)(std::move(problem)); };
    if (names_volume(options.input))
    {
        std::optional<io::volume_file> file;
        report.seconds.read =
            command.clock.timed([&] { file = read_volume_at_rest(options.input, options.rest, options.zone); });
        require_name(options.output, *file);
        require_drawable(*file, {options.picture, options.clip});
        require_mesh(*file);
        return with_case(*file, [&]<class Element>(const volume_case<Element>& input)
                         { return untangled(problem_of(input, options, report), &input); });
    }
    if (names_surface(options.input))
        throw io::io_error(options.input, "is a surface in space, which has no inverted elements; move it with `taut "
                                          "deform`, or map it to the plane with `taut unwrap`");
    std::optional<decltype(io::read_prob({}))> file;
    report.seconds.read = command.clock.timed([&] { file = io::read_prob(options.input); });
    return std::visit(
        [&]<class Element>(io::impl::prob_file<Element>& read)
        {
            auto problem = make_untangle_problem(std::move(read));
            const auto as_file = file_of(problem);
            require_drawable(as_file, {options.picture, options.clip});
            require_mesh(as_file);
            return untangled(std::move(problem));
        },
        *file);
}

} // namespace

command add_untangle(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<untangle_options>();
    declare(program.add_subcommand("untangle", "Make a map, or a volume, injective with some vertices fixed"),
            *options);
    return [options, launch](const outputs& files) { return run(*options, files, launch); };
}

} // namespace taut::tools
