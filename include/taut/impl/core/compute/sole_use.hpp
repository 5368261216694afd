// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <thread>

namespace taut::impl
{

/// One thread's use of something that only one thread at a time may use, as long as the object lives. Uses of one
/// thread nest.
class sole_use
{
public:
    using user = std::atomic<std::thread::id>; ///< the thread that is at it, if any

    /// refuse() is called if another thread is at it, and throws.
    template <class Refuse>
    sole_use(user& current, Refuse&& refuse) : current_(current)
    {
        std::thread::id found;
        began_ = current_.compare_exchange_strong(found, std::this_thread::get_id());
        if (!began_ && found != std::this_thread::get_id()) refuse();
    }
    ~sole_use()
    {
        if (began_) current_.store(std::thread::id());
    }
    sole_use(const sole_use&) = delete;
    sole_use& operator=(const sole_use&) = delete;

private:
    user& current_;
    bool began_ = false;
};

} // namespace taut::impl
