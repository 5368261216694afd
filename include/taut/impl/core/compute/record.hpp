// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/program/few_functions.hpp>
#include <taut/impl/core/compute/program/joined_source.hpp>
#include <taut/impl/core/compute/queue_state.hpp>
#include <taut/recording.hpp>

namespace taut::impl
{

/// Refuses a range that runs beyond a buffer which the kernel reads or writes at the index itself.
void require_range(const queue_state& state, const kernel_text& text, const range& r,
                   std::span<const argument> arguments);

/// Recorded kernels assume that what they write overlaps nothing else, so a buffer that is written is bound once.
void require_distinct(const queue_state& state, const kernel_text& text, std::span<const argument> arguments);

/// Refuses a recording that computes in double, even inside only, on a device that cannot.
void require_fp64(const queue_state& state, const kernel_text& text);

/// Form of recorded kernels on a device: rows for the host, long runs of indices for other CPUs, one index per item for
/// GPUs. All take any count; see kernel_form.
kernel_form form_for(const device& d);

/// The same of functions that kernels written by hand call.
inline kernel_form part_form_for(const device& d)
{
    return d.is_host() ? kernel_form::host : kernel_form::part;
}

/// The items that a recorded kernel needs for r.global indices; r.local is the group size where items are grouped.
range items_for(kernel_form form, const range& r);

/// The number of indices as the kernel takes it.
idx count_of(const queue_state& state, const std::string& name, const range& r);

/// Kernels that are recorded one by one and built as one program: what a driver does once a build, it does once for all
/// of them (PoCL reads OpenCL's header, some 50 ms, even where its cache holds the program).
///
///     const traced_program p(q, {record_value(..), record_gradient(..)});
///     const recorded_kernel value(p, "value");
class traced_program
{
public:
    /// common: kernels that other such programs have, too, as a program apart, which the driver's cache may hold.
    /// Throws parameter_error for two kernels of one name.
    traced_program(taut::queue q, std::vector<kernel_text> texts, std::vector<kernel_text> common = {});

    /// Source of the program in OpenCL C, without the parts kept apart.
    const std::string& source() const noexcept { return source_; }

    /// Source of the program that contains a kernel. Throws parameter_error for an unknown name.
    const std::string& source_of(const std::string& name) const
    {
        return position(name) < common_begin_ ? source_ : common_source_;
    }

    /// The kernel of that name, as it was recorded. Throws parameter_error for a name that is not there.
    const kernel_text& text(const std::string& name) const { return texts_[position(name)]; }

    /// Builds the program, and has kernels of it compiled elsewhere, where somebody does: see
    /// queue_options::build_elsewhere.
    void share(const std::vector<std::string>& names) const;

    taut::queue& queue() const noexcept { return queue_; }

private:
    std::size_t position(const std::string& name) const;

    mutable taut::queue queue_;
    std::string source_, common_source_;
    std::size_t common_begin_;
    std::vector<kernel_text> texts_;
};

/// A kernel recorded from C++: built once, launched many times with other buffers.
class recorded_kernel
{
public:
    recorded_kernel() = default;
    recorded_kernel(queue& q, const kernel_text& text) : recorded_kernel(q, text, text.source) {}
    recorded_kernel(const traced_program& p, const std::string& name);

    /// Runs over the indices 0 .. r.global - 1, for any number of them. The group size r.local counts on GPUs alone.
    /// Arguments are bound by the names of the recording, or by position.
    event operator()(range r, std::initializer_list<named_argument> arguments) const
    {
        return (*this)(r, std::span(arguments.begin(), arguments.size()));
    }
    event operator()(range r, const std::vector<named_argument>& arguments) const
    {
        return (*this)(r, std::span(arguments));
    }
    event operator()(range r, std::span<const named_argument> arguments) const;
    template <class... Args>
        requires(sizeof...(Args) > 0 && (std::is_constructible_v<impl::argument, const Args&> && ...))
    event operator()(range r, const Args&... args) const
    {
        impl::argument arguments[] = {args..., idx(0)};
        return launch(r, arguments);
    }

    /// arguments: all of them, and room for the count of indices.
    event launch(range r, std::span<impl::argument> arguments) const;

    /// The OpenCL C that was recorded, with its name and arguments.
    const kernel_text& text() const noexcept { return text_; }

private:
    recorded_kernel(queue& q, kernel_text text, const std::string& source);

    [[noreturn]] void refuse(const std::string& why) const { throw parameter_error("kernel " + text_.name, why); }

    std::size_t position(const char* name, std::size_t guess) const;

    std::shared_ptr<impl::queue_state> state_;
    kernel_text text_;
    kernel kernel_;
};

} // namespace taut::impl
