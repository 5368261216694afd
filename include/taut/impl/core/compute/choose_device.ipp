// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/choose_device.hpp>
#include <taut/impl/core/compute/drivers.hpp>
#include <taut/impl/core/compute/one_process.hpp>
#include <taut/impl/core/compute/quirks.hpp>

namespace taut::impl
{

std::string device_refusal(const device& d, const device_requirements& needs)
{
    if (!d.available()) return "not available (in use, or disabled)";
    if (!d.has_compiler()) return "its driver has no compiler";
    if (!d.is_host() && d.opencl_version() < 120)
        return "OpenCL " + std::to_string(d.opencl_version() / 100) + ".x, 1.2 is needed";
    if (needs.fp64 && !d.has_fp64()) return "no double precision (fp64)";
    if (d.global_memory() < needs.memory) return "too little memory: " + std::to_string(d.global_memory()) + " bytes";
    return {};
}

/// devices(), or of OpenCL's those alone that the host does not go before: GPUs, for which PoCL, whose first answer
/// takes a while, is not asked.
inline std::vector<listed_device> listed_devices(const device_requirements& needs, bool before_host)
{
    // Loaders and drivers set themselves up at the first question, and not all of them can be asked by several threads
    // at a time then.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    std::vector<listed_device> all;
    const auto list = [&](device d)
    {
        std::string why = device_refusal(d, needs);
        all.push_back({std::move(d), std::move(why)});
    };
    for (const opencl_platform& platform : opencl_platforms())
    {
        if (before_host && quirks::is_pocl(platform.name)) continue;
        refuse_fork("listing devices");
        for (device& d : opencl_devices(platform, before_host)) list(std::move(d));
    }
    list(device::host());
    return all;
}

} // namespace taut::impl

namespace taut
{

std::vector<listed_device> devices(const device_requirements& needs)
{
    return impl::listed_devices(needs, false);
}

} // namespace taut

namespace taut::impl
{

inline std::string lower(std::string text)
{
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// The whole number that the text is, if it is one.
inline std::optional<std::size_t> as_number(const std::string& text)
{
    if (text.empty() || text.size() > 6 ||
        !std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); }))
        return std::nullopt;
    return static_cast<std::size_t>(std::stoul(text));
}

/// Larger is better: double precision first, then GPU, the host, a CPU, others; then units times clock.
inline auto device_rank(const device& d)
{
    const int kind = d.is_gpu() ? 3 : d.is_host() ? 2 : d.is_cpu() ? 1 : 0;
    return std::tuple(d.has_fp64(), kind, d.compute_units() * std::max<std::size_t>(d.clock(), 1));
}

/// Whether TAUT_FORM asks for kernels in the form for GPUs. Throws parameter_error.
inline bool wants_gpu_form()
{
    const char* form = std::getenv("TAUT_FORM");
    if (!form || !*form) return false;
    if (std::string(form) != "gpu") throw parameter_error("TAUT_FORM", "is \"" + std::string(form) + "\", not \"gpu\"");
    return true;
}

[[noreturn]] inline void refuse(const std::string& headline, const std::vector<listed_device>& all)
{
    std::string text = headline + "\n";
    const auto platforms = opencl_platforms();
    if (platforms.empty())
    {
        const char* folder = std::getenv("OCL_ICD_VENDORS");
        text += "  no OpenCL platform is installed (drivers are registered in " +
                std::string(folder ? folder : "/etc/OpenCL/vendors") + ")\n";
    }
    for (const auto& platform : platforms)
    {
        text += "  platform " + platform.name + ", " + platform.version + "\n";
        bool any = false;
        for (std::size_t i = 0; i < all.size(); ++i)
        {
            const auto& [d, why] = all[i];
            if (d.native_platform() != platform.id) continue;
            any = true;
            text += "    " + std::to_string(i) + ": " + d.name() + ": " + (why.empty() ? "usable" : why) + "\n";
        }
        if (!any) text += "    no device\n";
    }
    for (const auto& [d, why] : all)
        if (d.is_host()) text += "  " + d.name() + ": " + (why.empty() ? "usable" : why) + "\n";
    throw no_device(text + "  install a driver: on Debian and Ubuntu pocl-opencl-icd (any CPU), nvidia-opencl-icd, "
                           "intel-opencl-icd or mesa-opencl-icd; `clinfo -l` lists what is seen");
}

} // namespace taut::impl

namespace taut
{

device find_device(const std::string& wish, const device_requirements& needs, const std::string& said)
{
    const bool as_gpu = impl::wants_gpu_form(); // which the host does not have
    const std::string wanted = impl::lower(wish);
    const auto number = impl::as_number(wanted);
    const bool host_serves = !as_gpu && impl::device_refusal(device::host(), needs).empty();
    if (host_serves && wanted == "host") return device::host();

    const auto all = impl::listed_devices(needs, host_serves && wanted.empty());
    const device* best = nullptr;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const auto& [d, why] = all[i];
        if (!why.empty() || (as_gpu && d.is_host())) continue;
        if (number && *number != i) continue;
        const std::string names = impl::lower(d.name() + '\n' + d.vendor() + '\n' + d.platform());
        if (!number && names.find(wanted) == std::string::npos) continue;
        if (!best || impl::device_rank(*best) < impl::device_rank(d)) best = &d;
    }
    if (best) return as_gpu ? best->as_gpu() : *best;
    impl::refuse("no device fits" + (wanted.empty() ? "" : ' ' + said + wish), impl::listed_devices(needs, false));
}

device find_device(const device_requirements& needs)
{
    const char* wish = std::getenv("TAUT_DEVICE");
    return find_device(wish ? wish : "", needs, "TAUT_DEVICE=");
}

} // namespace taut
