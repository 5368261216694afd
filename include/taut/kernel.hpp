// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_COMPUTE
#endif
#ifndef TAUT_KERNEL_HPP
#define TAUT_KERNEL_HPP

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/kernel_value.hpp>
#include <taut/queue.hpp>
#include <taut/recording.hpp>
#include <taut/reductions.hpp>
#include <taut/traced_vectors.hpp>

/// Kernels of your own: recorded from C++ with traced scalars, or in OpenCL C.
///
///     queue q;
///     buffer<double> x(q, xs), y(q, ys);
///     q.submit([&](handler& h) {
///         auto in = x.read(h);
///         auto out = y.read_write(h);
///         auto a = h.uniform(alpha);                     // an argument, not a literal
///         h.parallel_for(n, [=](auto i) { out[i] = a * in[i] + out[i]; });
///     });
///
/// Errors: device_error names the kernel, the argument and the reason; build_error has the compiler's log and the lines
/// of the source; tape_error is for mistakes in a recording.
namespace taut::impl
{

class recorded_kernel;

/// What a tag of a traced kernel says of its argument.
struct declared_argument
{
    argument_kind kind;
    scalar_type type;
};

/// Throws device_error where the recording says otherwise.
std::shared_ptr<const recorded_kernel> traced(queue& q, kernel_text text, std::span<const declared_argument> tags);

const kernel_text& text_of(const recorded_kernel& k);

kernel_form form_for(const device& d);

} // namespace taut::impl

namespace taut
{

/// Kernel of OpenCL C source, for devices of OpenCL; the host compiles none. A launch sets the arguments and enqueues
/// it; nothing waits. Arguments are bound by name, in any order, or by position:
///
///     kernel scale(q, source, "scale");
///     scale(n, {{"x", x}, {"factor", 2.0}});
///     scale(n, x, 2.0f);
///
/// By name, types are checked, and a number of type double narrows to what the kernel takes.
class kernel
{
public:
    struct body;

    /// Argument of a launch: a buffer, or a number of 32 or 64 bits.
    class argument : public impl::kernel_value
    {
    public:
        template <class T>
        argument(const buffer<T>& b) : kernel_value(impl::memory_of(b))
        {
        }
        argument(const real_buffer& b) : argument(real_view(b)) {}
        argument(const real_view& b) : kernel_value(*b.memory_) {}
        template <impl::device_scalar T>
        argument(T number) : kernel_value(impl::cl_name<T>(), &number, sizeof number)
        {
        }
    };

    /// Argument with the name of its parameter.
    struct named_argument
    {
        const char* name;
        argument value;
    };

    kernel() = default;

    /// real: value of the source's macro REAL. options: of the driver's compiler. Throws build_error, or device_error
    /// where the kernel takes double and the device has none.
    kernel(queue& q, const std::string& source, const std::string& name, const std::string& options = {},
           scalar_type real = scalar_type::f32);
    explicit kernel(std::shared_ptr<const body> b);

    /// Throws parameter_error for an argument that is missing, unknown, there twice, or of another type.
    event operator()(range r, std::initializer_list<named_argument> arguments) const
    {
        return launch(r, std::span(arguments.begin(), arguments.size()));
    }
    event launch(range r, std::span<const named_argument> arguments) const;

    /// By position; OpenCL checks sizes only. Throws parameter_error for another number of arguments.
    event operator()(range r, std::span<const argument> arguments) const;
    template <class... Args>
        requires(sizeof...(Args) > 0 && (std::is_constructible_v<argument, const Args&> && ...))
    event operator()(range r, const Args&... args) const
    {
        const argument arguments[] = {args...};
        return (*this)(r, std::span<const argument>(arguments));
    }

    const std::string& name() const noexcept;
    explicit operator bool() const noexcept { return body_ != nullptr; }

private:
    std::shared_ptr<const body> body_;
};

} // namespace taut

namespace taut::impl
{

using argument = kernel::argument;
using named_argument = kernel::named_argument;

/// The kernel of a source whose arguments have these types. Throws device_error if it takes another number of them.
kernel typed(queue& q, const std::string& source, const std::string& name, const std::string& options,
             std::span<const number_type> arguments);

event launch(const recorded_kernel& k, range r, std::span<argument> arguments);

template <class T>
inline constexpr number_type element_type = number_type_of<T>;

template <class T>
inline constexpr number_type element_type<buffer<T>> = number_type_of<T>;

template <class T>
inline constexpr number_type element_type<const buffer<T>> = number_type_of<T>;

} // namespace taut::impl

namespace taut
{

/// A kernel of OpenCL C with the C++ types of its arguments, in the order of its signature: buffer<T> for __global T*,
/// const buffer<T> for __global const T*, and scalars.
///
///     auto scale = q.kernel<buffer<float>, float>(source, "scale");
///     scale(n, x, 2.0f);
template <class... Args>
class typed_kernel
{
public:
    /// A buffer is passed by reference, a number by value.
    template <class Argument>
    using passed = std::conditional_t<std::is_arithmetic_v<Argument>, Argument, Argument&>;

    typed_kernel() = default;

    /// Throws build_error, or device_error if the kernel takes another number of arguments or double where the device
    /// has none.
    typed_kernel(queue& q, const std::string& source, const std::string& name, const std::string& options = {})
        : kernel_(impl::typed(q, source, name, options, std::vector<impl::number_type>{impl::element_type<Args>...}))
    {
    }

    event operator()(range r, passed<Args>... args) const { return kernel_(r, args...); }

    const std::string& name() const noexcept { return kernel_.name(); }
    explicit operator bool() const noexcept { return bool(kernel_); }

private:
    taut::kernel kernel_;
};

template <class... Args>
typed_kernel<Args...> queue::kernel(const std::string& source, const std::string& name, const std::string& options)
{
    return typed_kernel<Args...>(*this, source, name, options);
}

/// Tag of a traced kernel's argument: a buffer that it reads.
template <impl::traceable T>
struct in
{
    using passed = const buffer<T>&;
    static constexpr argument_kind kind = argument_kind::in;
    static constexpr scalar_type type = impl::scalar_type_of<T>;
    static auto declare(recording& r) { return r.in<T>(); }
};

/// Tag of a traced kernel's argument: a buffer that it writes.
template <impl::traceable T>
struct out
{
    using passed = buffer<T>&;
    static constexpr argument_kind kind = argument_kind::out;
    static constexpr scalar_type type = impl::scalar_type_of<T>;
    static auto declare(recording& r) { return r.out<T>(); }
};

/// Tag of a traced kernel's argument: a buffer that it reads and writes.
template <impl::traceable T>
struct inout
{
    using passed = buffer<T>&;
    static constexpr argument_kind kind = argument_kind::inout;
    static constexpr scalar_type type = impl::scalar_type_of<T>;
    static auto declare(recording& r) { return r.inout<T>(); }
};

/// Tag of a traced kernel's argument: a number that may change from launch to launch.
template <impl::traceable T>
struct uniform
{
    using passed = T;
    static constexpr argument_kind kind = argument_kind::scalar;
    static constexpr scalar_type type = impl::scalar_type_of<T>;
    static auto declare(recording& r) { return r.scalar<T>(); }
};

/// Kernel recorded from C++, with tags for its arguments. See trace().
template <class... Tags>
class traced_kernel
{
public:
    traced_kernel() = default;

    /// Throws device_error where the recording has other arguments than the tags say, or no count (kernel_form::item).
    traced_kernel(queue& q, kernel_text text)
        : kernel_(impl::traced(q, std::move(text), std::vector<impl::declared_argument>{{Tags::kind, Tags::type}...}))
    {
    }

    event operator()(range r, typename Tags::passed... args) const
    {
        kernel::argument arguments[] = {args..., idx(0)};
        return impl::launch(*kernel_, r, arguments);
    }

    /// The OpenCL C that was recorded, with its name and arguments.
    const kernel_text& text() const noexcept { return impl::text_of(*kernel_); }

private:
    std::shared_ptr<const impl::recorded_kernel> kernel_;
};

/// Records f(i, arguments...) as a kernel, once; i is the index, and each tag becomes a traced argument:
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
    std::tuple arguments{r.global_id(), Tags::declare(r)...};
    std::apply(std::forward<F>(f), std::move(arguments));
    return traced_kernel<Tags...>(q, r.finish(std::move(name), impl::form_for(q.device())));
}

/// Command group: the buffers it uses, their access, and the kernel that runs over a range. See queue::submit().
///
/// The lambda is recorded again at each submit and its kernel found in the queue's cache by its text, so a stale kernel
/// is impossible. Where recording is too slow (some 10 us for a small kernel), keep a traced_kernel instead.
class handler
{
public:
    explicit handler(queue& q) : queue_(q) {}
    handler(const handler&) = delete;
    handler& operator=(const handler&) = delete;

    /// A number that may change between submits without a new build.
    template <impl::traceable T>
    sym<T> uniform(T value)
    {
        arguments_.emplace_back(value);
        return recording_.scalar<T>();
    }

    /// The same for a real number in the precision of the recording: f32 or f64.
    sym<double> uniform(scalar_type type, double value);

    /// Implement read, write and read_write of buffers.
    template <impl::traceable T>
    recording::in_array<T> reads(const buffer<T>& b)
    {
        arguments_.emplace_back(b);
        return recording_.in<T>();
    }
    template <impl::traceable T>
    recording::out_array<T> writes(buffer<T>& b)
    {
        arguments_.emplace_back(b);
        return recording_.out<T>();
    }
    template <impl::traceable T>
    recording::inout_array<T> updates(buffer<T>& b)
    {
        arguments_.emplace_back(b);
        return recording_.inout<T>();
    }
    recording::in_array<double> reads(const real_buffer& b);
    recording::out_array<double> writes(real_buffer& b);
    recording::inout_array<double> updates(real_buffer& b);

    /// Records f and enqueues it over the indices 0 .. r.global - 1: once in a group. f takes the index, a sym<idx>.
    /// name: for errors and profilers. Throws device_error for a buffer that is written and bound twice, and for one
    /// that is used at the index itself and is shorter than the range.
    template <class F>
    void parallel_for(const std::string& name, range r, F&& f)
    {
        begin(name);
        std::forward<F>(f)(recording_.global_id());
        launch(name, r);
    }
    template <class F>
    void parallel_for(range r, F&& f)
    {
        parallel_for("parallel_for", r, std::forward<F>(f));
    }

    /// Event of the kernel, once it is enqueued.
    const event& done() const noexcept { return done_; }

private:
    void begin(const std::string& name);
    void launch(const std::string& name, range r);

    queue queue_;
    recording recording_;
    std::vector<kernel::argument> arguments_;
    bool launched_ = false;
    event done_;
};

template <class F>
event queue::submit(F&& f)
{
    handler group(*this);
    std::forward<F>(f)(group);
    return group.done();
}

} // namespace taut

#endif
#include <taut/impl/leave.inl>
