// SPDX-License-Identifier: MIT
#include "shared/build_elsewhere.hpp"

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

#include <taut/impl/core/compute/quirks.hpp>
#include <taut/impl/core/sparse/block_matrix.hpp>

#include "shared/child.hpp"
#include "shared/own_kernels.hpp"

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

/// Input of `taut build-kernels`.
struct order
{
    std::vector<std::string> arguments; ///< none: it cannot
    std::string input;
};

/// Order of the kernels of matrices, the one whole program that it can launch.
order order_of(const std::string& options, const taut::device& device)
{
    for (const int dimension : {2, 3})
        for (const auto real : {scalar_type::f32, scalar_type::f64})
            if (options ==
                impl::block_program(real, dimension, dimension + 1, impl::lane_form::for_device(device)).options())
                return {{"build-kernels", std::to_string(dimension), std::string(impl::spelling(real))}, {}};
    return {};
}

order order_of(const std::string& source, const std::string& options, const std::vector<std::string>& kernels)
{
    order o{{"build-kernels"}, options + '\n'};
    for (const auto& name : kernels) o.input += name + ' ';
    o.input += '\n' + source;
    return o;
}

/// A process at work.
struct work
{
    work(const order& o, const fs::path& result) : process(o.arguments, environment(), patience, o.input), mark(result)
    {
    }

    /// Waits a moment for its end.
    bool goes_on()
    {
        if (over) return false;
        auto news = process.news();
        ::poll(news.data(), news.size(), moment);
        over = process.look().has_value();
        if (over) std::ofstream{mark}; // also where it failed: what it has not built, this process will
        return !over;
    }

    child process;
    fs::path mark;
    bool over = false;
};

} // namespace

queue_options::builder build_elsewhere(const taut::device& device, const std::string& wish)
{
    const auto folder = kernels_of_pocl();
    const bool kept = variable("POCL_KERNEL_CACHE") != "0" && ::access(folder.c_str(), W_OK) == 0;
    const bool useful =
        impl::quirks::is_pocl(device) && device.compute_units() > 1 && std::thread::hardware_concurrency() > 1;
    if (!useful || !kept) return {};
    const auto latest = std::make_shared<std::shared_ptr<work>>();
    return [=](const std::string& source, const std::string& options,
               const std::vector<std::string>& kernels) -> queue_options::wait_for_build
    {
        auto order = kernels.empty() ? order_of(options, device) : order_of(source, options, kernels);
        const auto mark =
            folder /
            ("taut-" + std::to_string(std::hash<std::string>()(device.label() + options + order.input + source)));
        std::error_code failure;
        if (order.arguments.empty() || fs::exists(mark, failure)) return {};
        if (*latest && (*latest)->goes_on())
        {
            // A third process would take from the other two what it gives: these kernels are for this one.
            std::ofstream{mark};
            return {};
        }
        if (!wish.empty()) order.arguments.insert(order.arguments.end(), {"--device", wish});
        try
        {
            *latest = std::make_shared<work>(order, mark);
            return [at = *latest] { return at->goes_on(); };
        }
        catch (const std::system_error&)
        {
            return {};
        }
    };
}

} // namespace taut::tools
