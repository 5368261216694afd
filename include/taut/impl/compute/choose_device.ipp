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

#include <taut/impl/compute/choose_device.hpp>
#include <taut/impl/compute/one_process.hpp>
#include <taut/impl/compute/opencl.hpp>

namespace taut::impl
{

std::string device_refusal(const device& d, const device_requirements& needs)
{
    if (!d.available()) return "not available (in use, or disabled)";
    if (!d.has_compiler()) return "its driver has no compiler";
    if (d.opencl_version() < 120) return "OpenCL " + std::to_string(d.opencl_version() / 100) + ".x, 1.2 is needed";
    if (needs.fp64 && !d.has_fp64()) return "no double precision (fp64)";
    if (d.global_memory() < needs.memory) return "too little memory: " + std::to_string(d.global_memory()) + " bytes";
    return {};
}

} // namespace taut::impl

namespace taut
{

std::vector<impl::listed_device> devices(const device_requirements& needs)
{
    impl::refuse_fork("listing devices");
    // Loaders and drivers set themselves up at the first question, and not all of them can be asked by several threads
    // at a time then.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    std::vector<impl::listed_device> all;
    for (const auto& platform : boost::compute::system::platforms())
    {
        std::vector<boost::compute::device> found;
        try
        {
            found = platform.devices();
        }
        catch (const boost::compute::opencl_error&)
        {
            // A platform without a device answers with an error; find_device lists it by name.
        }
        for (const auto& handle : found)
        {
            device d(handle.id());
            std::string why = impl::device_refusal(d, needs);
            all.push_back({std::move(d), std::move(why)});
        }
    }
    return all;
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

/// Larger is better: double precision first, then GPU, accelerator, CPU; then units times clock.
inline auto device_rank(const device& d)
{
    const int kind = d.is_gpu() ? 2 : d.is_cpu() ? 0 : 1;
    return std::tuple(d.has_fp64(), kind, d.compute_units() * std::max<std::size_t>(d.clock(), 1));
}

/// The device with the form of kernels that TAUT_FORM asks for. Throws parameter_error.
inline device in_wanted_form(const device& d)
{
    const char* form = std::getenv("TAUT_FORM");
    if (!form || !*form) return d;
    if (std::string(form) != "gpu") throw parameter_error("TAUT_FORM", "is \"" + std::string(form) + "\", not \"gpu\"");
    return d.as_gpu();
}

[[noreturn]] inline void refuse(const std::string& headline, const std::vector<listed_device>& all)
{
    std::string text = headline + "\n";
    const auto platforms = boost::compute::system::platforms();
    if (platforms.empty())
    {
        const char* folder = std::getenv("OCL_ICD_VENDORS");
        text += "  no OpenCL platform is installed (drivers are registered in " +
                std::string(folder ? folder : "/etc/OpenCL/vendors") + ")\n";
    }
    for (const auto& platform : platforms)
    {
        text += "  platform " + platform.name() + ", " + platform.version() + "\n";
        bool any = false;
        for (std::size_t i = 0; i < all.size(); ++i)
        {
            const auto& [d, why] = all[i];
            if (d.native_platform() != platform.id()) continue;
            any = true;
            text += "    " + std::to_string(i) + ": " + d.name() + ": " + (why.empty() ? "usable" : why) + "\n";
        }
        if (!any) text += "    no device\n";
    }
    throw no_device(text + "  install a driver: on Debian and Ubuntu pocl-opencl-icd (any CPU), nvidia-opencl-icd, "
                           "intel-opencl-icd or mesa-opencl-icd; `clinfo -l` lists what is seen");
}

device find_device(const std::string& wish, const device_requirements& needs, const std::string& said)
{
    const auto all = devices(needs);
    const std::string wanted = impl::lower(wish);
    const auto number = impl::as_number(wanted);

    const device* best = nullptr;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const auto& [d, why] = all[i];
        if (!why.empty()) continue;
        if (number && *number != i) continue;
        const std::string names = impl::lower(d.name() + '\n' + d.vendor() + '\n' + d.platform());
        if (!number && names.find(wanted) == std::string::npos) continue;
        if (!best || impl::device_rank(*best) < impl::device_rank(d)) best = &d;
    }
    if (best) return impl::in_wanted_form(*best);
    impl::refuse("no OpenCL device fits" + (wanted.empty() ? "" : ' ' + said + wish), all);
}

} // namespace taut::impl

namespace taut
{

device find_device(const std::string& wish, const device_requirements& needs)
{
    return impl::find_device(wish, needs, "the wish ");
}

device find_device(const device_requirements& needs)
{
    const char* wish = std::getenv("TAUT_DEVICE");
    return impl::find_device(wish ? wish : "", needs, "TAUT_DEVICE=");
}

} // namespace taut
