// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/compute/kernel.hpp>
#include <taut/impl/compute/program/few_functions.hpp>
#include <taut/impl/compute/program/joined_source.hpp>
#include <taut/impl/compute/quirks.hpp>
#include <taut/impl/symbolic/recording.hpp>

namespace taut
{

/// Tag of a traced kernel's argument: a buffer that it reads.
template <impl::traceable T>
struct in
{
};
/// Tag of a traced kernel's argument: a buffer that it writes.
template <impl::traceable T>
struct out
{
};
/// Tag of a traced kernel's argument: a buffer that it reads and writes.
template <impl::traceable T>
struct inout
{
};
/// Tag of a traced kernel's argument: a number that may change from launch to launch.
template <impl::traceable T>
struct uniform
{
};

} // namespace taut

namespace taut::impl
{

template <class Tag>
struct tag_traits;

template <class T>
struct tag_traits<in<T>>
{
    using typed = const buffer<T>;
    static constexpr auto kind = argument_kind::in;
    static constexpr auto type = scalar_type_of<T>;
    static auto declare(recording& r) { return r.in<T>(); }
};
template <class T>
struct tag_traits<out<T>>
{
    using typed = buffer<T>;
    static constexpr auto kind = argument_kind::out;
    static constexpr auto type = scalar_type_of<T>;
    static auto declare(recording& r) { return r.out<T>(); }
};
template <class T>
struct tag_traits<inout<T>>
{
    using typed = buffer<T>;
    static constexpr auto kind = argument_kind::inout;
    static constexpr auto type = scalar_type_of<T>;
    static auto declare(recording& r) { return r.inout<T>(); }
};
template <class T>
struct tag_traits<uniform<T>>
{
    using typed = T;
    static constexpr auto kind = argument_kind::scalar;
    static constexpr auto type = scalar_type_of<T>;
    static auto declare(recording& r) { return r.scalar<T>(); }
};

/// Refuses a range that runs beyond a buffer which the kernel reads or writes at the index itself.
inline void require_range(const queue_state& state, const kernel_text& text, const range& r,
                          std::span<const argument> arguments)
{
    for (const std::size_t i : text.by_index)
        if (r.global > arguments[i].elements())
            state.fail("launching " + text.name, "argument " + std::to_string(i) + " is used at [i] for " +
                                                     std::to_string(r.global) + " indices, and the buffer has " +
                                                     std::to_string(arguments[i].elements()) + " elements");
}

/// Recorded kernels assume that what they write overlaps nothing else, so a buffer that is written is bound once.
inline void require_distinct(const queue_state& state, const kernel_text& text, std::span<const argument> arguments)
{
    for (std::size_t i = 0; i < arguments.size(); ++i)
        for (std::size_t j = i + 1; j < arguments.size(); ++j)
            if (arguments[i].memory() && arguments[i].memory() == arguments[j].memory() &&
                (text.arguments[i].kind != argument_kind::in || text.arguments[j].kind != argument_kind::in))
                state.fail("launching " + text.name,
                           "arguments " + std::to_string(i) + " and " + std::to_string(j) +
                               " are one buffer, and the kernel writes to it; use read_write once");
}

/// Refuses a recording that computes in double, even inside only, on a device that cannot.
inline void require_fp64(const queue_state& state, const kernel_text& text)
{
    if (!state.device.has_fp64() && text.source.find("cl_khr_fp64") != std::string::npos)
        state.fail("building kernel " + text.name,
                   "it computes in double and the device has no double precision (fp64); trace it with float");
}

/// Form of recorded kernels on a device: long runs of indices for CPUs, one index per item for GPUs. Both take any
/// count; see kernel_form.
inline kernel_form form_for(const device& d)
{
    return quirks::wants_serial_items(d) ? kernel_form::run : kernel_form::guarded;
}

/// The items that a recorded kernel needs for r.global indices; r.local is the group size where items are grouped.
inline range items_for(kernel_form form, const range& r)
{
    constexpr std::size_t length = run_length;
    if (form == kernel_form::run) return {(r.global + length - 1) / length, 1};
    const std::size_t group = r.local ? r.local : 128;
    return {padded(r.global, group), group};
}

/// The number of indices as the kernel takes it.
inline idx count_of(const queue_state& state, const std::string& name, const range& r)
{
    if (r.global > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
        state.fail("launching " + name, "more than 2^31 indices");
    return static_cast<idx>(r.global);
}

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
    traced_program(taut::queue q, std::vector<kernel_text> texts, std::vector<kernel_text> common = {})
        : queue_(std::move(q)),
          source_(impl::joined_source(texts)),
          common_source_(impl::joined_source(common)),
          common_begin_(texts.size()),
          texts_(std::move(texts))
    {
        std::move(common.begin(), common.end(), std::back_inserter(texts_));
    }

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
    void share(const std::vector<std::string>& names) const
    {
        const auto use = queue_.state()->enter();
        queue_.state()->cache.share(source_, impl::few_functions, names);
    }

    taut::queue& queue() const noexcept { return queue_; }

private:
    std::size_t position(const std::string& name) const
    {
        for (std::size_t k = 0; k < texts_.size(); ++k)
            if (texts_[k].name == name) return k;
        throw parameter_error(name, "the program has no kernel of this name");
    }

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
    recorded_kernel(const traced_program& p, const std::string& name)
        : recorded_kernel(p.queue(), p.text(name), p.source_of(name))
    {
    }

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
    event operator()(range r, std::span<const named_argument> arguments) const
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
    template <class... Args>
        requires(sizeof...(Args) > 0 && (std::is_constructible_v<impl::argument, const Args&> && ...))
    event operator()(range r, const Args&... args) const
    {
        impl::argument arguments[] = {args..., idx(0)};
        return launch(r, arguments);
    }

    /// The OpenCL C that was recorded, with its name and arguments.
    const kernel_text& text() const noexcept { return text_; }

private:
    recorded_kernel(queue& q, kernel_text text, const std::string& source) : state_(q.state()), text_(std::move(text))
    {
        impl::require_fp64(*state_, text_);
        if (text_.form == kernel_form::item) state_->fail("kernel " + text_.name, "it was recorded without a count");
        kernel_ = {q, source, text_.name, impl::few_functions, std::vector<impl::parameter>{}};
    }

    /// arguments: all of them, and room for the count of indices.
    event launch(range r, std::span<impl::argument> arguments) const
    {
        if (arguments.size() != text_.arguments.size())
            refuse("it takes " + std::to_string(text_.arguments.size() - 1) + " arguments, not " +
                   std::to_string(arguments.size() - 1));
        for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
        {
            const auto& declared = text_.arguments[i];
            arguments[i] = arguments[i].as(spelling(declared.type));
            if (arguments[i].is_memory() != (declared.kind != argument_kind::scalar) ||
                arguments[i].type() != spelling(declared.type))
                refuse(declared.name + " is of another type: " + std::string(spelling(declared.type)));
        }
        arguments.back() = impl::count_of(*state_, text_.name, r);
        impl::require_distinct(*state_, text_, arguments);
        impl::require_range(*state_, text_, r, arguments);
        return kernel_(impl::items_for(text_.form, r), std::span<const impl::argument>(arguments));
    }

    [[noreturn]] void refuse(const std::string& why) const { throw parameter_error("kernel " + text_.name, why); }

    std::size_t position(const char* name, std::size_t guess) const
    {
        const std::size_t n = text_.arguments.size() - 1;
        for (std::size_t k = 0; k < n; ++k, ++guess)
        {
            if (guess >= n) guess = 0;
            if (text_.arguments[guess].name == name) return guess;
        }
        refuse(std::string("it has no argument ") + name);
    }

    std::shared_ptr<impl::queue_state> state_;
    kernel_text text_;
    kernel kernel_;
};

} // namespace taut::impl

namespace taut
{

/// Kernel recorded from C++, with tags for its arguments. See trace().
template <class... Tags>
class traced_kernel
{
public:
    traced_kernel() = default;
    traced_kernel(queue& q, impl::kernel_text text) : kernel_(q, checked(q, std::move(text))) {}

    event operator()(range r,
                     typename impl::argument_traits<typename impl::tag_traits<Tags>::typed>::passed... args) const
    {
        return kernel_(r, args...);
    }

    /// The OpenCL C that was recorded, with its name and arguments.
    const impl::kernel_text& text() const noexcept { return kernel_.text(); }

private:
    /// The tags must tell what the recording says, and the text must take a count.
    static impl::kernel_text checked(queue& q, impl::kernel_text text)
    {
        constexpr std::size_t n = sizeof...(Tags);
        constexpr std::array<impl::argument_kind, n> kinds = {impl::tag_traits<Tags>::kind...};
        constexpr std::array<scalar_type, n> types = {impl::tag_traits<Tags>::type...};
        bool same = text.form != impl::kernel_form::item && text.arguments.size() == n + 1;
        for (std::size_t i = 0; same && i < n; ++i)
            same = text.arguments[i].kind == kinds[i] && text.arguments[i].type == types[i];
        if (!same)
            q.state()->fail("kernel " + text.name,
                            "its recording has other arguments than the tags of traced_kernel, or no count");
        return text;
    }

    impl::recorded_kernel kernel_;
};

/// Records f(i, arguments...) as an OpenCL kernel; i is the index, and each tag becomes a traced
/// argument:
///
///     auto axpy = trace<in<double>, inout<double>, uniform<double>>(q, "axpy",
///         [](auto i, auto x, auto y, auto a) { y[i] = a * x[i] + y[i]; });
///     axpy(n, bx, by, 0.5);
///
/// Host values that f captures become literals of the kernel. Throws build_error, or device_error where the device has
/// no double and the recording needs it.
template <class... Tags, class F>
traced_kernel<Tags...> trace(queue& q, std::string name, F&& f)
{
    recording r;
    // Braces fix the order of the declarations.
    std::tuple arguments{r.global_id(), impl::tag_traits<Tags>::declare(r)...};
    std::apply(std::forward<F>(f), std::move(arguments));
    return traced_kernel<Tags...>(q, r.finish(std::move(name), impl::form_for(q.device())));
}

} // namespace taut
