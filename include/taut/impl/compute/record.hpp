// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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
void require_range(const queue_state& state, const kernel_text& text, const range& r,
                   std::span<const argument> arguments);

/// Recorded kernels assume that what they write overlaps nothing else, so a buffer that is written is bound once.
void require_distinct(const queue_state& state, const kernel_text& text, std::span<const argument> arguments);

/// Refuses a recording that computes in double, even inside only, on a device that cannot.
void require_fp64(const queue_state& state, const kernel_text& text);

/// Form of recorded kernels on a device: long runs of indices for CPUs, one index per item for GPUs. Both take any
/// count; see kernel_form.
inline kernel_form form_for(const device& d)
{
    return quirks::wants_serial_items(d) ? kernel_form::run : kernel_form::guarded;
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

    /// The OpenCL C that was recorded, with its name and arguments.
    const kernel_text& text() const noexcept { return text_; }

private:
    recorded_kernel(queue& q, kernel_text text, const std::string& source);

    /// arguments: all of them, and room for the count of indices.
    event launch(range r, std::span<impl::argument> arguments) const;

    [[noreturn]] void refuse(const std::string& why) const { throw parameter_error("kernel " + text_.name, why); }

    std::size_t position(const char* name, std::size_t guess) const;

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

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/record.ipp>
#endif
