// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <taut/device.hpp>
#include <taut/impl/core/compute/kernels/functions.hpp>
#include <taut/impl/core/compute/opencl/boost_compute.hpp>
#include <taut/impl/core/compute/program/build_excerpt.hpp>
#include <taut/impl/core/compute/program/few_functions.hpp>
#include <taut/impl/core/compute/quirks.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// The programs that a queue has built, by source text and build options, with their kernel objects. The queue owns it,
/// so device and driver are part of the key by ownership, and nothing outlives the driver. Kernels are kept, not only
/// programs: a kernel object carries what the driver compiled for it. Not safe between threads.
class program_cache
{
public:
    /// quick, elsewhere: see queue_options.
    program_cache(boost::compute::context context, taut::device device, bool quick, queue_options::builder elsewhere)
        : context_(std::move(context)), device_(std::move(device)), quick_(quick), elsewhere_(std::move(elsewhere))
    {
    }

    /// A program that will be needed: the other builder hears of it, once.
    void expect(const std::string& source, const std::string& options);

    /// Builds a program, and the other builder hears of kernels of it, once. Does nothing where there is none.
    void share(const std::string& source, const std::string& options, const std::vector<std::string>& kernels);

    /// Returns the build of the program by another thread or process, null if there is none.
    queue_options::wait_for_build under_way(const std::string& source, const std::string& options) const;
    /// Returns the build of a kernel of the program, null if there is none.
    queue_options::wait_for_build under_way(const std::string& source, const std::string& options,
                                            const std::string& name) const;

    /// The kernel of that name, built at the first request. Throws build_error if the compiler refuses the source and
    /// device_error if the program has no such kernel.
    const boost::compute::kernel& find(const std::string& source, const std::string& name, const std::string& options);

    /// Programs built so far, and the seconds that building them took.
    std::size_t builds() const noexcept { return builds_; }
    double seconds() const noexcept { return seconds_; }

private:
    struct entry
    {
        boost::compute::program program;
        bool built = false;
        std::vector<std::string> shared;
        queue_options::wait_for_build whole, part; ///< elsewhere: the program, and the kernels that it shares
        std::unordered_map<std::string, boost::compute::kernel> kernels;
    };

    void build(entry& target, const std::string& source, const std::string& name, const std::string& options);

    /// Without warnings: PoCL counts them on the standard error, and without AVX-512 warns of vectors of 512 bits.
    void compile(entry& target, const std::string& source, const std::string& options);

    /// Builds a program that says it calls few functions without OpenCL's header of all of them, where drivers leave it
    /// out for its guard. False for other programs, and for what such a driver refuses: it may do better with the
    /// header.
    bool built_without_header(entry& target, const std::string& source, const std::string& options);

    /// Log of the compiler; empty if the driver failed earlier.
    std::string log_of(const boost::compute::program& program) const;

    boost::compute::context context_;
    taut::device device_;
    bool quick_;
    queue_options::builder elsewhere_;
    std::unordered_map<std::string, entry> entries_;
    std::size_t builds_ = 0;
    double seconds_ = 0;
};

} // namespace taut::impl
