// SPDX-License-Identifier: MIT
#include <chrono>
#include <memory>

#include "commands.hpp"
#include "deform/shell_run.hpp"
#include "shared/command_run.hpp"
#include "shared/shared_options.hpp"
#include "volume/shape_options.hpp"
#include "volume/shape_run.hpp"

namespace taut::tools
{

namespace
{

exit_code run(const shape_options& options, const outputs& files, std::chrono::steady_clock::time_point launch)
{
    command_run command(options, files, launch);
    if (!options.smoothing && names_surface(options.input))
    {
        if (options.refine) throw usage_error("--refine is for volumes and planar meshes; leave it out");
        if (options.zone > 0) throw usage_error("--zone is for SU2 files; leave it out");
        return shell_run(options, command)();
    }
    if (options.thickness)
        throw usage_error("--thickness is for surfaces in space (.obj, .off, .ply, .stl); leave it out");
    command.tell("read");
    auto file = read_volume_at_rest(options.input, options.rest, options.zone);
    if (options.smoothing) file.rest.clear();
    require_drawable(file, {options.picture, options.clip, options.smoothing});
    require_mesh(file);
    return with_case(file, [&]<class Element>(const volume_case<Element>& input)
                     { return shape_run<Element>(options, command, input)(); });
}

} // namespace

command add_deform(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<shape_options>();
    declare_deform(program.add_subcommand("deform",
                                          "Deform a volume, a planar mesh, or a surface in space under fixed and moved "
                                          "vertices"),
                   *options);
    return [options, launch](const outputs& files) { return run(*options, files, launch); };
}

command add_smooth(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<shape_options>();
    declare_smooth(
        program.add_subcommand("smooth", "Smooth a mesh: move vertices to improve the shapes of its elements"),
        *options);
    return [options, launch](const outputs& files) { return run(*options, files, launch); };
}

} // namespace taut::tools
