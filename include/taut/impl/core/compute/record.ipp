// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>

#include <taut/impl/core/compute/quirks.hpp>
#include <taut/impl/core/compute/record.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/impl/core/symbolic/emit.hpp>
#include <taut/impl/core/symbolic/row_program.hpp>

namespace taut::impl
{

void require_range(const queue_state& state, const kernel_text& text, const range& r,
                   std::span<const argument> arguments)
{
    for (const std::size_t i : text.by_index)
        if (r.global > arguments[i].elements())
            state.fail("launching " + text.name, "argument " + std::to_string(i) + " is used at [i] for " +
                                                     std::to_string(r.global) + " indices, and the buffer has " +
                                                     std::to_string(arguments[i].elements()) + " elements");
}

void require_distinct(const queue_state& state, const kernel_text& text, std::span<const argument> arguments)
{
    for (std::size_t i = 0; i < arguments.size(); ++i)
        for (std::size_t j = i + 1; j < arguments.size(); ++j)
            if (arguments[i].memory() && arguments[i].memory() == arguments[j].memory() &&
                (text.arguments[i].kind != argument_kind::in || text.arguments[j].kind != argument_kind::in))
                state.fail("launching " + text.name,
                           "arguments " + std::to_string(i) + " and " + std::to_string(j) +
                               " are one buffer, and the kernel writes to it; use read_write once");
}

inline bool computes_in_double(const row_program& rows)
{
    const auto is_double = [](const auto& x) { return x.type == scalar_type::f64; };
    return std::any_of(rows.arguments.begin(), rows.arguments.end(), is_double) ||
           std::any_of(rows.uniforms.begin(), rows.uniforms.end(),
                       [](const auto& u) { return u.what.type == scalar_type::f64; }) ||
           std::find(rows.widths.begin(), rows.widths.end(), sizeof(double)) != rows.widths.end();
}

void require_fp64(const queue_state& state, const kernel_text& text)
{
    const bool wide = text.rows ? computes_in_double(*text.rows) : text.source.find("cl_khr_fp64") != std::string::npos;
    if (!state.device.has_fp64() && wide)
        state.fail("building kernel " + text.name,
                   "it computes in double and the device has no double precision (fp64); trace it with float");
}

kernel_form form_for(const device& d)
{
    if (d.is_host()) return kernel_form::host;
    return quirks::wants_serial_items(d) ? kernel_form::run : kernel_form::guarded;
}

range items_for(kernel_form form, const range& r)
{
    constexpr std::size_t length = run_length;
    if (form == kernel_form::host) return r.global;
    if (form == kernel_form::run) return {(r.global + length - 1) / length, 1};
    const std::size_t group = r.local ? r.local : 128;
    return {padded(r.global, group), group};
}

idx count_of(const queue_state& state, const std::string& name, const range& r)
{
    if (r.global > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
        state.fail("launching " + name, "more than 2^31 indices");
    return static_cast<idx>(r.global);
}

traced_program::traced_program(taut::queue q, std::vector<kernel_text> texts, std::vector<kernel_text> common)
    : queue_(std::move(q)),
      source_(impl::joined_source(texts)),
      common_source_(impl::joined_source(common)),
      common_begin_(texts.size()),
      texts_(std::move(texts))
{
    std::move(common.begin(), common.end(), std::back_inserter(texts_));
}

void traced_program::share(const std::vector<std::string>& names) const
{
    const auto use = state_of(queue_)->enter();
    state_of(queue_)->commands->share(source_, names);
}

std::size_t traced_program::position(const std::string& name) const
{
    for (std::size_t k = 0; k < texts_.size(); ++k)
        if (texts_[k].name == name) return k;
    throw parameter_error(name, "the program has no kernel of this name");
}

recorded_kernel::recorded_kernel(const traced_program& p, const std::string& name)
    : recorded_kernel(p.queue(), p.text(name), p.source_of(name))
{
}

event recorded_kernel::operator()(range r, std::span<const named_argument> arguments) const
{
    std::vector<impl::argument> by_position(text_.arguments.size(), idx(0));
    std::vector<bool> bound(text_.arguments.size() - 1);
    std::size_t at = 0;
    for (const auto& a : arguments)
    {
        at = position(a.name, at);
        if (bound[at]) refuse(std::string("it has ") + a.name + " twice");
        bound[at] = true;
        by_position[at++] = a.value;
    }
    for (std::size_t i = 0; i < bound.size(); ++i)
        if (!bound[i]) refuse("it needs an argument " + text_.arguments[i].name);
    return launch(r, by_position);
}

recorded_kernel::recorded_kernel(queue& q, kernel_text text, const std::string& source)
    : state_(state_of(q)), text_(std::move(text))
{
    impl::require_fp64(*state_, text_);
    if (text_.form == kernel_form::item) state_->fail("kernel " + text_.name, "it was recorded without a count");
    kernel_ = make_kernel(q, text_, source);
}

event recorded_kernel::launch(range r, std::span<impl::argument> arguments) const
{
    if (arguments.size() != text_.arguments.size())
        refuse("it takes " + std::to_string(text_.arguments.size() - 1) + " arguments, not " +
               std::to_string(arguments.size() - 1));
    for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
    {
        const auto& declared = text_.arguments[i];
        arguments[i].narrow_to(spelling(declared.type));
        if (arguments[i].is_memory() != (declared.kind != argument_kind::scalar) ||
            arguments[i].type() != spelling(declared.type))
            refuse(declared.name + " is of another type: " + std::string(spelling(declared.type)));
    }
    arguments.back() = impl::count_of(*state_, text_.name, r);
    impl::require_distinct(*state_, text_, arguments);
    impl::require_range(*state_, text_, r, arguments);
    return kernel_(impl::items_for(text_.form, r), std::span<const impl::argument>(arguments));
}

std::size_t recorded_kernel::position(const char* name, std::size_t guess) const
{
    const std::size_t n = text_.arguments.size() - 1;
    for (std::size_t k = 0; k < n; ++k, ++guess)
    {
        if (guess >= n) guess = 0;
        if (text_.arguments[guess].name == name) return guess;
    }
    refuse(std::string("it has no argument ") + name);
}

std::shared_ptr<const recorded_kernel> traced(queue& q, kernel_text text, std::span<const declared_argument> tags)
{
    const std::size_t n = tags.size();
    bool same = text.form != kernel_form::item && text.arguments.size() == n + 1;
    for (std::size_t i = 0; same && i < n; ++i)
        same = text.arguments[i].kind == tags[i].kind && text.arguments[i].type == tags[i].type;
    if (!same)
        state_of(q)->fail("kernel " + text.name,
                          "its recording has other arguments than the tags of traced_kernel, or no count");
    return std::make_shared<const recorded_kernel>(q, text);
}

const kernel_text& text_of(const recorded_kernel& k)
{
    return k.text();
}

event launch(const recorded_kernel& k, range r, std::span<argument> arguments)
{
    return k.launch(r, arguments);
}

} // namespace taut::impl

namespace taut
{

sym<double> handler::uniform(scalar_type type, double value)
{
    arguments_.push_back(impl::number_of(impl::spelling(type), value));
    return recording_.scalar<double>({}, type);
}

recording::in_array<double> handler::reads(const real_buffer& b)
{
    arguments_.emplace_back(b);
    return recording_.in<double>({}, b.type());
}

recording::out_array<double> handler::writes(real_buffer& b)
{
    arguments_.emplace_back(b);
    return recording_.out<double>({}, b.type());
}

recording::inout_array<double> handler::updates(real_buffer& b)
{
    arguments_.emplace_back(b);
    return recording_.inout<double>({}, b.type());
}

void handler::begin(const std::string& name)
{
    if (launched_)
        impl::state_of(queue_)->fail("launching " + name, "a command group has one parallel_for; submit another group");
    launched_ = true;
}

void handler::launch(const std::string& name, range r)
{
    auto& state = *impl::state_of(queue_);
    const kernel_text text = recording_.finish(name, impl::form_for(state.device));
    impl::require_fp64(state, text);
    impl::require_distinct(state, text, arguments_);
    impl::require_range(state, text, r, arguments_);
    const auto use = state.enter();
    const auto compiled = state.commands->of_recording(text, text.source);
    arguments_.emplace_back(impl::count_of(state, name, r));
    done_ = state.launch(*compiled, name, arguments_, impl::items_for(text.form, r));
}

} // namespace taut
