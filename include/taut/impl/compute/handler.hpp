// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/compute/record.hpp>
#include <taut/impl/symbolic/loop.hpp>

namespace taut
{

/// Command group: the buffers it uses, their access, and the kernel that runs over a range.
///
///     q.submit([&](handler& h) {
///         auto x = bx.read(h);
///         auto y = by.read_write(h);
///         auto a = h.uniform(alpha);                     // an argument, not a literal
///         h.parallel_for(n, [=](auto i) { y[i] = a * x[i] + y[i]; });
///     });
///
/// The lambda is recorded again at each submit and its kernel found in the queue's cache by its text, so a stale kernel
/// is impossible. Where recording is too slow (some 10 us for a small kernel), keep a traced_kernel instead.
class handler
{
public:
    explicit handler(queue& q) : state_(q.state()) {}
    handler(const handler&) = delete;
    handler& operator=(const handler&) = delete;

    /// A number that may change between submits without a new build.
    template <impl::traceable T>
    sym<T> uniform(T value)
    {
        arguments_.emplace_back(value);
        return recording_.scalar<T>();
    }

    /// The same for a real number in the precision of the recording.
    sym<double> uniform(scalar_type type, double value)
    {
        arguments_.push_back(impl::argument(value).as(impl::spelling(type)));
        return recording_.scalar<double>({}, type);
    }

    /// Implements buffer::read, write and read_write.
    template <impl::traceable T>
    impl::in_array<T> reads(const buffer<T>& b)
    {
        arguments_.emplace_back(b);
        return recording_.in<T>();
    }
    impl::in_array<double> reads(const impl::real_buffer& b)
    {
        arguments_.emplace_back(b);
        return recording_.in<double>({}, b.type());
    }
    template <impl::traceable T>
    impl::out_array<T> writes(buffer<T>& b)
    {
        arguments_.emplace_back(b);
        return recording_.out<T>();
    }
    impl::out_array<double> writes(impl::real_buffer& b)
    {
        arguments_.emplace_back(b);
        return recording_.out<double>({}, b.type());
    }
    template <impl::traceable T>
    impl::inout_array<T> updates(buffer<T>& b)
    {
        arguments_.emplace_back(b);
        return recording_.inout<T>();
    }
    impl::inout_array<double> updates(impl::real_buffer& b)
    {
        arguments_.emplace_back(b);
        return recording_.inout<double>({}, b.type());
    }

    /// Records f and enqueues it over the indices 0 .. r.global - 1: once in a group. f takes the index, a sym<idx>.
    template <class F>
    void parallel_for(range r, F&& f)
    {
        parallel_for("parallel_for", r, std::forward<F>(f));
    }

    /// The same with a name for errors and profilers.
    template <class F>
    void parallel_for(const std::string& name, range r, F&& f)
    {
        if (launched_) state_->fail("launching " + name, "a command group has one parallel_for; submit another group");
        launched_ = true;
        std::forward<F>(f)(recording_.global_id());
        const impl::kernel_text text = recording_.finish(name, impl::form_for(state_->device));
        impl::require_fp64(*state_, text);
        impl::require_distinct(*state_, text, arguments_);
        impl::require_range(*state_, text, r, arguments_);
        const auto use = state_->enter();
        const auto& kernel = state_->cache.find(text.source, text.name, impl::few_functions);
        cl_uint i = 0;
        for (const auto& a : arguments_) a.set(*state_, kernel.get(), name, i++);
        impl::argument(impl::count_of(*state_, name, r)).set(*state_, kernel.get(), name, i);
        done_ = state_->launch(kernel, name, impl::items_for(text.form, r));
    }

    /// Event of the kernel, once it is enqueued.
    const event& done() const noexcept { return done_; }

private:
    std::shared_ptr<impl::queue_state> state_;
    recording recording_;
    std::vector<impl::argument> arguments_;
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
