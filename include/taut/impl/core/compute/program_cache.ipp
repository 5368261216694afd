// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include <taut/impl/core/compute/program/program_store.hpp>
#include <taut/impl/core/compute/program_cache.hpp>

namespace taut::impl
{

void program_cache::expect(const std::string& source, const std::string& options)
{
    if (!elsewhere_ || quick_) return;
    const auto [found, unknown] = entries_.try_emplace(options + '\0' + source);
    if (unknown) found->second.whole = elsewhere_(source, options, {});
}

void program_cache::share(const std::string& source, const std::string& options,
                          const std::vector<std::string>& kernels)
{
    if (!elsewhere_ || quick_ || kernels.empty()) return;
    entry& found = entries_.try_emplace(options + '\0' + source).first->second;
    if (!found.shared.empty()) return;
    if (!found.built) build(found, source, kernels.front(), options);
    found.shared = kernels;
    found.part = elsewhere_(source, options, kernels);
}

queue_options::wait_for_build program_cache::under_way(const std::string& source, const std::string& options) const
{
    const auto found = entries_.find(options + '\0' + source);
    return found == entries_.end() ? nullptr : found->second.whole;
}

queue_options::wait_for_build program_cache::under_way(const std::string& source, const std::string& options,
                                                       const std::string& name) const
{
    const auto found = entries_.find(options + '\0' + source);
    if (found == entries_.end()) return nullptr;
    const auto& shared = found->second.shared;
    return std::find(shared.begin(), shared.end(), name) == shared.end() ? nullptr : found->second.part;
}

const boost::compute::kernel& program_cache::find(const std::string& source, const std::string& name,
                                                  const std::string& options)
{
    entry& found = entries_.try_emplace(options + '\0' + source).first->second;
    const auto known = found.kernels.find(name);
    if (known != found.kernels.end()) return known->second;

    if (!found.built) build(found, source, name, options);
    try
    {
        return found.kernels.emplace(name, found.program.create_kernel(name)).first->second;
    }
    catch (const boost::compute::opencl_error& e)
    {
        throw device_error("creating kernel " + name, "the program has no such kernel (" + e.error_string() + ")",
                           device_.label(), e.error_code());
    }
}

void program_cache::build(entry& target, const std::string& source, const std::string& name, const std::string& options)
{
    const auto start = std::chrono::steady_clock::now();
    try
    {
        if (!built_without_header(target, source, options)) compile(target, source, options);
    }
    catch (const boost::compute::opencl_error& e)
    {
        std::string log = log_of(target.program);
        if (log.empty()) log = e.error_string();
        if (log.back() != '\n') log += '\n';
        throw build_error(name, log, impl::build_excerpt(source, log), device_.label(), e.error_code());
    }
    target.built = true;
    ++builds_;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void program_cache::compile(entry& target, const std::string& source, const std::string& options)
{
    program_store::of(device_).build(target.program, context_, device_, source,
                                     (quick_ ? "-cl-std=CL1.2 -w -cl-opt-disable " : "-cl-std=CL1.2 -w ") + options);
}

bool program_cache::built_without_header(entry& target, const std::string& source, const std::string& options)
{
    if (!quirks::reads_long_header(device_) || !options.starts_with(impl::few_functions)) return false;
    try
    {
        compile(target, impl::kernels::functions + ("#line 1\n" + source), options + " -D_OPENCL_H_");
        return true;
    }
    catch (const boost::compute::opencl_error&)
    {
        return false;
    }
}

std::string program_cache::log_of(const boost::compute::program& program) const
{
    if (!program.get()) return {};
    try
    {
        return program.get_build_info<std::string>(CL_PROGRAM_BUILD_LOG, boost::compute::device(device_.native()));
    }
    catch (const boost::compute::opencl_error&)
    {
        return {};
    }
}

} // namespace taut::impl
