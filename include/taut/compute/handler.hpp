// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/compute/record.hpp>

namespace taut
{

/// One command group: which buffers it uses, how, and the kernel that runs over a range.
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
    template <traceable T>
    sym<T> uniform(T value)
    {
        bind(nullptr, detail::elements_of(value),
             [value](const auto& state, cl_kernel k, const auto& name, cl_uint i)
             { detail::set_argument(state, k, name, i, value); });
        return recording_.scalar<T>();
    }

    /// Behind buffer::read, write and read_write.
    template <traceable T>
    in_array<T> reads(const buffer<T>& b)
    {
        bind(b);
        return recording_.in<T>();
    }
    template <traceable T>
    out_array<T> writes(buffer<T>& b)
    {
        bind(b);
        return recording_.out<T>();
    }
    template <traceable T>
    inout_array<T> updates(buffer<T>& b)
    {
        bind(b);
        return recording_.inout<T>();
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
        const kernel_text text = recording_.finish(name, detail::form_for(state_->device));
        detail::require_fp64(*state_, text);
        detail::require_distinct(*state_, text, memory_);
        detail::require_range(*state_, text, r, elements_);
        const auto use = state_->enter();
        const auto& kernel = state_->cache.find(text.source, text.name, {});
        cl_uint i = 0;
        for (const binding& b : bindings_) b(*state_, kernel.get(), name, i++);
        detail::set_argument(*state_, kernel.get(), name, i, detail::count_of(*state_, name, r));
        done_ = state_->launch(kernel, name, detail::items_for(text.form, r));
    }

    /// Of the kernel, once it is enqueued.
    const event& done() const noexcept { return done_; }

private:
    using binding = std::function<void(const detail::queue_state&, cl_kernel, const std::string&, cl_uint)>;

    void bind(cl_mem memory, std::size_t elements, binding b)
    {
        memory_.push_back(memory);
        elements_.push_back(elements);
        bindings_.push_back(std::move(b));
    }
    template <class T>
    void bind(const buffer<T>& b)
    {
        bind(b.native(), b.size(),
             [&b](const auto& state, cl_kernel k, const auto& name, cl_uint i)
             { detail::set_argument(state, k, name, i, b); });
    }

    std::shared_ptr<detail::queue_state> state_;
    recording recording_;
    std::vector<cl_mem> memory_;
    std::vector<std::size_t> elements_;
    std::vector<binding> bindings_;
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
