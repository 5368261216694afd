// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace taut::impl
{

/// Makes values one after the other on a thread of its own, while the caller uses those that are done.
template <class T>
class made_ahead
{
public:
    /// make(k), k = 0 .. count - 1, runs on the other thread; what it refers to lives as long as this.
    made_ahead(std::size_t count, const std::function<T(std::size_t)>& make) : values_(count)
    {
        try
        {
            thread_ = std::thread([this, make] { run(make); });
        }
        catch (const std::system_error&)
        {
            run(make); // no more threads to be had
        }
    }
    made_ahead(const made_ahead&) = delete;
    made_ahead& operator=(const made_ahead&) = delete;

    /// Drops results whose computation has not begun.
    ~made_ahead()
    {
        unwanted_ = true;
        if (thread_.joinable()) thread_.join();
    }

    /// Returns value k, once, as soon as it is made; throws the exception of make(k).
    T take(std::size_t k) { return values_[k].get_future().get(); }

private:
    void run(const std::function<T(std::size_t)>& make)
    {
        for (auto& value : values_) try
            {
                if (unwanted_) return;
                value.set_value(make(static_cast<std::size_t>(&value - values_.data())));
            }
            catch (...)
            {
                value.set_exception(std::current_exception());
            }
    }

    std::vector<std::promise<T>> values_;
    std::atomic<bool> unwanted_{false};
    std::thread thread_;
};

} // namespace taut::impl
