// SPDX-License-Identifier: MIT
#include "build_elsewhere.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <poll.h>
#include <unistd.h>

#include <taut/compute/quirks.hpp>
#include <taut/sparse/block_matrix.hpp>

#include "child.hpp"

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

constexpr limits patience{.seconds = 20, .grace = 1}; // ten times what building takes
constexpr int moment = 10;                            ///< milliseconds

std::string variable(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// Where PoCL keeps kernels; empty where that is nowhere, or written by others.
fs::path kernels_of_pocl()
{
    fs::path folder;
    if (const auto named = variable("POCL_CACHE_DIR"); !named.empty())
        folder = named;
    else if (const auto caches = variable("XDG_CACHE_HOME"); !caches.empty())
        folder = fs::path(caches) / "pocl" / "kcache";
    else if (const auto home = variable("HOME"); !home.empty())
        folder = fs::path(home) / ".cache" / "pocl" / "kcache";
    return variable("POCL_KERNEL_CACHE") != "0" && ::access(folder.c_str(), W_OK) == 0 ? folder : fs::path();
}

/// What `taut build-kernels` is told to build the program with these options; empty for one that it does not build.
std::vector<std::string> arguments_of(const std::string& options, const taut::device& device)
{
    for (const int dimension : {2, 3})
        for (const auto real : {scalar_type::f32, scalar_type::f64})
            if (options == detail::block_options(real, dimension, dimension + 1, lane_form::for_device(device)))
                return {"build-kernels", std::to_string(dimension), std::string(spelling(real))};
    return {};
}

} // namespace

program_builder build_elsewhere(const taut::device& device, const std::string& wish)
{
    const auto folder = kernels_of_pocl();
    const bool useful =
        quirks::is_pocl(device) && device.compute_units() > 1 && std::thread::hardware_concurrency() > 1;
    if (!useful || folder.empty()) return {};
    return [=](const std::string& source, const std::string& options) -> std::function<bool()>
    {
        const auto mark =
            folder / ("taut-" + std::to_string(std::hash<std::string>()(device.label() + options + source)));
        auto arguments = arguments_of(options, device);
        std::error_code failure;
        if (arguments.empty() || fs::exists(mark, failure)) return {};
        if (!wish.empty()) arguments.insert(arguments.end(), {"--device", wish});
        try
        {
            const auto process = std::make_shared<child>(arguments, environment(), patience);
            return [=]
            {
                auto news = process->news();
                ::poll(news.data(), news.size(), moment);
                if (!process->look()) return true;
                std::ofstream{mark};
                return false;
            };
        }
        catch (const std::system_error&)
        {
            return {};
        }
    };
}

} // namespace taut::tools
