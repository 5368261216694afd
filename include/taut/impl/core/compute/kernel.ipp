// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/program/signature.hpp>
#include <taut/impl/core/compute/queue_state.hpp>

namespace taut
{

struct kernel::body
{
    template <class Compile>
    body(queue& q, std::string its_name, std::vector<impl::parameter> parameters, const Compile& compile)
        : state(impl::state_of(q)), name(std::move(its_name)), signature(std::move(parameters))
    {
        const auto use = state->enter();
        for (const auto& p : signature)
            if (p.type == "double") impl::require_fp64(*state, scalar_type::f64, "kernel " + name);
        compiled = compile(*state->commands);
    }

    [[noreturn]] void refuse(const std::string& why) const { throw parameter_error("kernel " + name, why); }

    static std::string describe(std::string_view type, bool is_memory)
    {
        return (is_memory ? "a buffer of " : "a number of type ") + std::string(type);
    }

    /// Position of the parameter; guess: its position if the arguments come in order.
    std::size_t position(const char* its_name, std::size_t guess) const
    {
        for (std::size_t k = 0; k < signature.size(); ++k, ++guess)
        {
            if (guess >= signature.size()) guess = 0;
            if (signature[guess].name == its_name) return guess;
        }
        refuse(std::string("it has no argument ") + its_name);
    }

    std::shared_ptr<impl::queue_state> state;
    std::shared_ptr<impl::compiled_kernel> compiled;
    std::string name;
    std::vector<impl::parameter> signature;
};

kernel::kernel(std::shared_ptr<const body> b) : body_(std::move(b)) {}

kernel::kernel(queue& q, const std::string& source, const std::string& name, const std::string& options,
               scalar_type real)
    : kernel(std::make_shared<body>(q, name, impl::signature_of(source, name, real),
                                    [&](impl::device_commands& on) { return on.of_text(source, name, options); }))
{
}

event kernel::launch(range r, std::span<const named_argument> arguments) const
{
    const auto use = body_->state->enter();
    const auto& signature = body_->signature;
    std::vector<argument> by_position(signature.size(), idx(0));
    std::vector<bool> bound(signature.size());
    std::size_t guess = 0;
    for (const named_argument& a : arguments)
    {
        guess = body_->position(a.name, guess);
        const auto& p = signature[guess];
        if (bound[guess]) body_->refuse("it has " + p.name + " twice");
        bound[guess] = true;
        argument value = a.value;
        value.narrow_to(p.type);
        if (value.is_memory() != p.is_memory || value.type() != p.type)
            body_->refuse(p.name + " is " + body::describe(p.type, p.is_memory) + ", not " +
                          body::describe(value.type(), value.is_memory()));
        by_position[guess++] = value;
    }
    for (std::size_t i = 0; i < bound.size(); ++i)
        if (!bound[i]) body_->refuse("it needs an argument " + signature[i].name);
    return body_->state->launch(*body_->compiled, body_->name, by_position, r);
}

event kernel::operator()(range r, std::span<const argument> arguments) const
{
    const auto use = body_->state->enter();
    if (arguments.size() != body_->compiled->arguments())
        body_->refuse("it takes " + std::to_string(body_->compiled->arguments()) + " arguments, not " +
                      std::to_string(arguments.size()));
    return body_->state->launch(*body_->compiled, body_->name, arguments, r);
}

const std::string& kernel::name() const noexcept
{
    static const std::string none;
    return body_ ? body_->name : none;
}

} // namespace taut

namespace taut::impl
{

kernel make_kernel(queue& q, const own_program& program, const std::string& name)
{
    return kernel(std::make_shared<kernel::body>(q, name, signature_of(program.text, name, program.real),
                                                 [&](device_commands& on) { return on.of_own(program, name); }));
}

kernel make_kernel(queue& q, const kernel_text& recorded, const std::string& source)
{
    return kernel(std::make_shared<kernel::body>(q, recorded.name, std::vector<parameter>{},
                                                 [&](device_commands& on)
                                                 { return on.of_recording(recorded, source); }));
}

kernel typed(queue& q, const std::string& source, const std::string& name, const std::string& options,
             std::span<const number_type> arguments)
{
    const queue_state& state = *state_of(q);
    for (const number_type& a : arguments)
        if (std::string_view(a.name) == "double") require_fp64(state, scalar_type::f64, "kernel " + name);
    auto made = std::make_shared<kernel::body>(q, name, std::vector<parameter>{},
                                               [&](device_commands& on) { return on.of_text(source, name, options); });
    if (made->compiled->arguments() != arguments.size())
        state.fail("kernel " + name, "it takes " + std::to_string(made->compiled->arguments()) + " arguments, not " +
                                         std::to_string(arguments.size()));
    return kernel(std::move(made));
}

event late_kernel::operator()(range r, std::initializer_list<named_argument> arguments) const
{
    if (!built_) built_ = build_();
    return built_(r, arguments);
}

} // namespace taut::impl
