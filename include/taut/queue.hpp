// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_COMPUTE
#endif
#ifndef TAUT_QUEUE_HPP
#define TAUT_QUEUE_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <taut/device.hpp>
#include <taut/impl/core/compute/device_memory.hpp>
#include <taut/impl/core/symbolic/scalar_type.hpp>
#include <taut/options.hpp>
#include <taut/types.hpp>

/// Command queues and memory on a device. <taut/kernel.hpp> has kernels, <taut/reductions.hpp> sums.
///
///     queue q;                                             // $TAUT_DEVICE, else the best device
///     buffer<double> x(q, std::vector<double>{1, 2, 3}), y(q, 3);
///     y.copy_from(x);                                      // enqueued
///     const std::vector<double> back = y.download();       // waits
///
/// Errors: no_device, device_error; parameter_error for elements beyond the end of a buffer.
namespace taut
{

class handler;
class queue;

template <class... Args>
class typed_kernel;

template <class T>
class buffer;

} // namespace taut

namespace taut::impl
{

struct queue_state;

const std::shared_ptr<queue_state>& state_of(const queue& q) noexcept;

template <class T>
const device_memory& memory_of(const buffer<T>& b) noexcept;

} // namespace taut::impl

namespace taut
{

/// Options of a queue.
struct queue_options
{
    /// Wait for a build that is under way in another process, for a moment; true: there is use in waiting on. Empty: no
    /// build is under way.
    using wait_for_build = std::function<bool()>;

    /// Begins to compile a program in another process, into the driver's cache. kernels: those that are wanted of a
    /// program that this process has built already, and that the cache so holds; empty: the whole of one that is not
    /// built yet.
    using builder = std::function<wait_for_build(const std::string& source, const std::string& options,
                                                 const std::vector<std::string>& kernels)>;

    bool profiling = false; ///< event::seconds() works; costs a little at each launch

    /// Kernels are compiled without optimisations: for programs that run once on small meshes with an empty kernel
    /// cache. With PoCL they are built in less than half of the time and take several times as long. The environment's
    /// TAUT_BUILD=quick has the same effect on every queue.
    bool quick_builds = false;

    /// Called with programs that will be needed later, and with kernels of one that is built.
    builder build_elsewhere = {};
};

/// The completion of one command. A default-constructed event stands for no command at all and is complete.
class event
{
public:
    class state;

    event() = default;
    explicit event(std::shared_ptr<const state> s);

    /// Blocks until the command has run. Each wait costs as much as seven to ten launches: wait for the last command of
    /// a queue, not for each.
    void wait() const;

    bool complete() const;

    /// Seconds between the command's start and end on the device; nothing unless the queue was made with profiling.
    std::optional<double> seconds() const;

    /// Null for no command, and on the host device.
    cl_event native() const;

private:
    std::shared_ptr<const state> state_;
};

/// Launch range: the number of work-items, and of those in one work-group. local = 0 lets the queue choose: 64 on a CPU
/// and 128 on a GPU where that divides global, else the driver's choice, which is slow for odd sizes. Pad buffers and
/// ranges instead.
struct range
{
    std::size_t global = 0;
    std::size_t local = 0;

    constexpr range(std::size_t all) : global(all) {} // NOLINT: k(n, ...) reads as it should
    constexpr range(std::size_t all, std::size_t group) : global(all), local(group) {}
};

/// An in-order queue of commands to one device, with its context and its cache of built programs. Copies share all of
/// it, and buffers and kernels keep it alive. Commands run in the order in which they are given; only downloads,
/// uploads, finish() and event::wait() block the host. One thread at a time: a second one gets a device_error.
class queue
{
public:
    /// Opens a queue on the best device, or the one that TAUT_DEVICE names. Throws no_device.
    queue() : queue(find_device()) {}

    explicit queue(const taut::device& device, queue_options options = {});

    /// Opens a queue in the user's context, on its first device. The context is retained.
    explicit queue(cl_context context, queue_options options = {});

    /// Wraps the user's command queue, which is retained and must be in-order.
    explicit queue(cl_command_queue native);

    const taut::device& device() const noexcept;

    /// Blocks until every command given so far has run.
    void finish();

    /// Records and enqueues one command group: f takes a handler&. Defined in <taut/kernel.hpp>.
    template <class F>
    event submit(F&& f);

    /// The kernel called name in OpenCL C source, with the C++ types of its arguments in order: buffer<T>,
    /// const buffer<T>, or a scalar. Built at the first request, then found in the cache. Defined in <taut/kernel.hpp>.
    template <class... Args>
    typed_kernel<Args...> kernel(const std::string& source, const std::string& name, const std::string& options = {});

    /// Launches, waits, transfers and builds since the queue was opened.
    queue_counters counters() const;

    /// Bytes in the living buffers of this queue.
    std::uint64_t allocated() const noexcept;

    /// Throw device_error on the host device.
    cl_command_queue native() const;
    cl_context native_context() const;

    friend bool operator==(const queue& a, const queue& b) { return a.state_ == b.state_; }
    friend std::ostream& operator<<(std::ostream& out, const queue& q) { return out << "queue on " << q.device(); }

private:
    friend const std::shared_ptr<impl::queue_state>& impl::state_of(const queue& q) noexcept;

    std::shared_ptr<impl::queue_state> state_;
};

/// Array of n numbers in the memory of a device. Move-only; n = 0 is legal. Transfers are explicit and block the host;
/// nothing is written back by a destructor. Fresh memory is uninitialised.
template <class T>
class buffer
{
    static_assert(impl::device_scalar<T>,
                  "buffer<T>: T must be float, double or a 32 or 64 bit integer; split structs and "
                  "vectors into one buffer a component");

public:
    using value_type = T;

    /// Makes an empty buffer without a queue, to be assigned.
    buffer() = default;

    /// Allocates n elements. Throws device_error where they exceed the largest allocation or the free memory of the
    /// device: drivers that allocate lazily would crash later instead.
    buffer(queue& q, std::size_t n) : memory_(q, impl::number_type_of<T>, n, nullptr) {}

    /// Allocates and fills with values, which is cheaper than an upload: no command waits for others.
    buffer(queue& q, std::span<const T> values) : memory_(q, impl::number_type_of<T>, values.size(), values.data()) {}
    buffer(queue& q, const std::vector<T>& values) : buffer(q, std::span<const T>(values)) {}

    std::size_t size() const noexcept { return memory_.size(); }
    bool empty() const noexcept { return size() == 0; }
    std::uint64_t bytes() const noexcept { return memory_.bytes(); }

    /// Copies values to elements offset, offset + 1, ... and waits.
    void upload(std::span<const T> values, std::size_t offset = 0)
    {
        memory_.write(values.data(), values.size(), offset);
    }
    void upload(const std::vector<T>& values, std::size_t offset = 0) { upload(std::span<const T>(values), offset); }

    /// Waits for the commands before it, then copies elements offset, offset + 1, ... into values.
    void download(std::span<T> values, std::size_t offset = 0) const
    {
        memory_.read(values.data(), values.size(), offset);
    }
    std::vector<T> download() const
    {
        std::vector<T> values(size());
        download(std::span<T>(values));
        return values;
    }

    /// Downloads elements 0, 1, ... without a wait: values are there, and must live, until the next command of this
    /// queue that waits: a download, an upload, finish().
    void begin_download(std::span<T> values) const { memory_.begin_read(values.data(), values.size()); }

    /// Sets every element; does not wait.
    void fill(T value) { memory_.fill(&value); }

    /// Copies all elements of other to elements offset, offset + 1, ...; does not wait.
    void copy_from(const buffer& other, std::size_t offset = 0) { memory_.copy_from(other.memory_, offset); }

    /// Accessors for a command group: what the recorded kernel does with the buffer.
    template <class Handler>
    auto read(Handler& h) const
    {
        require_recorded();
        return h.reads(*this);
    }
    template <class Handler>
    auto write(Handler& h)
    {
        require_recorded();
        return h.writes(*this);
    }
    template <class Handler>
    auto read_write(Handler& h)
    {
        require_recorded();
        return h.updates(*this);
    }

    /// Throws device_error on the host device.
    cl_mem native() const { return memory_.native(); }

    void swap(buffer& other) noexcept { std::swap(memory_, other.memory_); }

private:
    template <class U>
    friend const impl::device_memory& impl::memory_of(const buffer<U>& b) noexcept;

    static constexpr void require_recorded()
    {
        static_assert(impl::traceable<T>, "recorded kernels take buffers of float, double and std::int32_t");
    }

    impl::device_memory memory_;
};

/// n real numbers in the memory of a device, as float or as double: the precision is a value, not a type. On the host
/// they are double. Otherwise it is as buffer<T>.
class real_buffer
{
public:
    /// Real numbers on the host in the type that a buffer has on the device; an element reads as double.
    class numbers
    {
    public:
        numbers() = default;
        numbers(scalar_type type, std::size_t n);

        std::size_t size() const noexcept;
        double operator[](std::size_t i) const;

        /// Calls body with all of them, a span<const float> or span<const double>.
        template <class Body>
        void visit(const Body& body) const
        {
            std::visit([&](const auto& v) { body(std::span(v)); }, numbers_);
        }

    private:
        friend class real_buffer;
        std::variant<std::vector<float>, std::vector<double>> numbers_;
    };

    /// An empty buffer of no queue; assign another to it.
    real_buffer() = default;

    /// type: f32 or f64. Throws parameter_error, and device_error as buffer does.
    real_buffer(queue& q, scalar_type type, std::size_t n);
    real_buffer(queue& q, scalar_type type, std::span<const double> values);

    scalar_type type() const noexcept { return memory_.is_double() ? scalar_type::f64 : scalar_type::f32; }
    std::size_t size() const noexcept { return memory_.size(); }
    bool empty() const noexcept { return size() == 0; }
    std::uint64_t bytes() const noexcept { return memory_.bytes(); }

    void upload(std::span<const double> values, std::size_t offset = 0);
    void download(std::span<double> values, std::size_t offset = 0) const;
    std::vector<double> download() const;
    void begin_download(numbers& values) const;
    void fill(double value);
    /// other: of the same type.
    void copy_from(const real_buffer& other, std::size_t offset = 0);

    /// Accessors for a command group, in which the elements are sym<double> in the precision of the buffer.
    template <class Handler>
    auto read(Handler& h) const
    {
        return h.reads(*this);
    }
    template <class Handler>
    auto write(Handler& h)
    {
        return h.writes(*this);
    }
    template <class Handler>
    auto read_write(Handler& h)
    {
        return h.updates(*this);
    }

private:
    friend class real_view;

    impl::device_memory memory_;
};

} // namespace taut

namespace taut::impl
{

template <class T>
const device_memory& memory_of(const buffer<T>& b) noexcept
{
    return b.memory_;
}

} // namespace taut::impl

#endif
#include <taut/impl/leave.inl>
