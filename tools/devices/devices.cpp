// SPDX-License-Identifier: MIT
#include <sstream>
#include <string>

#include <taut/impl/core/compute/choose_device.hpp>

#include "commands.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

std::string kind(const device& d)
{
    return d.is_host() ? "host" : d.is_gpu() ? "GPU" : d.is_cpu() ? "CPU" : "accelerator";
}

exit_code list_devices()
{
    const device best = find_device(); // throws with the whole list if there is none
    text_table table;
    table.add({"", "#", "kind", "units", "memory", "fp64", "OpenCL"});
    const auto all = devices();
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const auto& [d, refusal] = all[i];
        const double gib = static_cast<double>(d.global_memory()) / (1 << 30);
        const std::string version =
            d.is_host() ? "-"
                        : std::to_string(d.opencl_version() / 100) + '.' + std::to_string(d.opencl_version() / 10 % 10);
        table.add({d.name() + (d == best ? " *" : "") + (refusal.empty() ? "" : " (refused: " + refusal + ")"),
                   std::to_string(i), kind(d), std::to_string(d.compute_units()), number(gib, 3) + " GiB",
                   d.has_fp64() ? "yes" : "no", version});
    }
    std::ostringstream out;
    out << table
        << "\n* is the default; --device or TAUT_DEVICE with a number or a part of the name changes "
           "that\n";
    write_standard_output(out.str());
    return exit_code::valid;
}

} // namespace

command add_devices(command_line& program)
{
    program.add_subcommand("devices", "List the devices of this machine and the default one")
        .footer("exit codes: 0 listed; 2 usage; 5 no device");
    return [](const outputs&) { return list_devices(); };
}

} // namespace taut::tools
