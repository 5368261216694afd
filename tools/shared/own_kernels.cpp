// SPDX-License-Identifier: MIT
#include "shared/own_kernels.hpp"

#include <cstdlib>
#include <string>
#include <system_error>

#include <taut/impl/core/compute/program/private_folder.hpp>
#include <taut/impl/core/compute/quirks.hpp>

#include "shared/failure.hpp"

namespace taut::tools
{

namespace fs = std::filesystem;

fs::path kernels_of_pocl()
{
    const auto variable = [](const char* name) -> std::string
    {
        const char* value = std::getenv(name);
        return value ? value : "";
    };
    if (const auto named = variable("POCL_CACHE_DIR"); !named.empty()) return named;
    if (const auto caches = variable("XDG_CACHE_HOME"); !caches.empty()) return fs::path(caches) / "pocl" / "kcache";
    if (const auto home = variable("HOME"); !home.empty()) return fs::path(home) / ".cache" / "pocl" / "kcache";
    return {};
}

void require_own_kernels(const taut::device& device)
{
    if (!impl::quirks::is_pocl(device)) return;
    const auto folder = kernels_of_pocl();
    if (folder.empty())
        throw usage_error("there is no HOME, and PoCL would keep compiled kernels in /tmp/pocl, where another user "
                          "may have put his; name a folder of your own with POCL_CACHE_DIR");
    std::error_code failure;
    if (!fs::is_directory(folder, failure)) return;
    if (const auto fault = impl::fault_of_folder(fs::canonical(folder, failure), 0002); !fault.empty())
        throw usage_error(folder.string() + ", where PoCL keeps compiled kernels: " + fault +
                          "; name a folder of your own with POCL_CACHE_DIR");
}

} // namespace taut::tools
