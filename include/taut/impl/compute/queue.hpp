// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>

#include <taut/impl/compute/choose_device.hpp>
#include <taut/impl/compute/program/program_builder.hpp>
#include <taut/impl/compute/queue_counters.hpp>

namespace taut::impl
{

struct queue_state;

} // namespace taut::impl

namespace taut
{

class event;
class handler;

} // namespace taut

namespace taut::impl
{

template <class... Args>
class typed_kernel;

} // namespace taut::impl

namespace taut
{

/// Options of a queue.
struct queue_options
{
    bool profiling = false; ///< event::seconds() works; costs a little at each launch

    /// Kernels are compiled without optimisations: for programs that run once on small meshes with an empty kernel
    /// cache. With PoCL they are built in less than half of the time and take several times as long. The environment's
    /// TAUT_BUILD=quick has the same effect on every queue.
    bool quick_builds = false;

    /// Callback with programs that will be needed later, and with kernels of one that is built.
    impl::program_builder build_elsewhere = {};
};

/// An in-order queue of commands to one device, with its context and its cache of built programs. Copies share all of
/// it, and buffers and kernels keep it alive. Commands run in the order in which they are given; only downloads,
/// uploads, finish() and event::wait() block the host. One thread at a time: the arguments of a kernel object are not
/// thread-safe.
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

    /// Records and enqueues one command group: f takes a handler&. Declared here, defined in handler.hpp.
    template <class F>
    event submit(F&& f);

    /// The kernel called name in OpenCL C source, with the C++ types of its arguments in order: buffer<T>,
    /// const buffer<T>, or a scalar. Built at the first request, then found in the cache. Defined in kernel.hpp.
    template <class... Args>
    impl::typed_kernel<Args...> kernel(const std::string& source, const std::string& name,
                                       const std::string& options = {});

    impl::queue_counters counters() const;

    /// Bytes in the living buffers of this queue.
    std::uint64_t allocated() const noexcept;

    cl_command_queue native() const;
    cl_context native_context() const;

    /// For the other headers of this folder.
    const std::shared_ptr<impl::queue_state>& state() const noexcept { return state_; }

    friend bool operator==(const queue& a, const queue& b) { return a.state_ == b.state_; }
    friend std::ostream& operator<<(std::ostream& out, const queue& q) { return out << "queue on " << q.device(); }

private:
    std::shared_ptr<impl::queue_state> state_;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/queue.ipp>
#endif
