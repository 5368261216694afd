// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/kernel.hpp>

namespace taut
{

kernel::kernel(queue& q, const std::string& source, const std::string& name, const std::string& options,
               scalar_type real)
    : kernel(q, source, name, options, impl::signature_of(source, name, real))
{
}

kernel::kernel(queue& q, const std::string& source, std::string name, const std::string& options,
               std::vector<impl::parameter> signature)
    : state_(q.state()), name_(std::move(name)), signature_(std::move(signature))
{
    const auto use = state_->enter();
    for (const auto& p : signature_)
        if (p.type == "double") impl::require_fp64(*state_, scalar_type::f64, "kernel " + name_);
    state_->await(state_->cache.under_way(source, options));
    kernel_ = state_->cache.find(source, name_, options);
    under_way_ = state_->cache.under_way(source, options, name_);
    count_ = kernel_.get_info<cl_uint>(CL_KERNEL_NUM_ARGS);
}

event kernel::launch(range r, std::span<const impl::named_argument> arguments) const
{
    const auto use = state_->enter();
    std::vector<bool> bound(signature_.size());
    std::size_t guess = 0;
    for (const impl::named_argument& a : arguments)
    {
        guess = position(a.name, guess);
        const auto& p = signature_[guess];
        if (bound[guess]) refuse("it has " + p.name + " twice");
        bound[guess] = true;
        const auto value = a.value.as(p.type);
        if (value.is_memory() != p.is_memory || value.type() != p.type)
            refuse(p.name + " is " + describe(p.type, p.is_memory) + ", not " +
                   describe(value.type(), value.is_memory()));
        value.set(*state_, kernel_.get(), name_, static_cast<cl_uint>(guess++));
    }
    for (std::size_t i = 0; i < bound.size(); ++i)
        if (!bound[i]) refuse("it needs an argument " + signature_[i].name);
    return enqueue(r);
}

event kernel::operator()(range r, std::span<const impl::argument> arguments) const
{
    const auto use = state_->enter();
    if (arguments.size() != count_)
        refuse("it takes " + std::to_string(count_) + " arguments, not " + std::to_string(arguments.size()));
    cl_uint i = 0;
    for (const auto& a : arguments) a.set(*state_, kernel_.get(), name_, i++);
    return enqueue(r);
}

void kernel::require_arguments(std::size_t n) const
{
    if (count_ != n)
        state_->fail("kernel " + name_, "it takes " + std::to_string(count_) + " arguments, not " + std::to_string(n));
}

event kernel::enqueue(range r) const
{
    if (under_way_) state_->await(std::exchange(under_way_, nullptr));
    return state_->launch(kernel_, name_, r);
}

std::size_t kernel::position(const char* name, std::size_t guess) const
{
    for (std::size_t k = 0; k < signature_.size(); ++k, ++guess)
    {
        if (guess >= signature_.size()) guess = 0;
        if (signature_[guess].name == name) return guess;
    }
    refuse(std::string("it has no argument ") + name);
}

} // namespace taut

namespace taut::impl
{

event late_kernel::operator()(range r, std::initializer_list<named_argument> arguments) const
{
    if (!built_) built_ = build_();
    return built_(r, arguments);
}

} // namespace taut::impl
