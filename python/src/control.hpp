// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include <taut/atlas.hpp>
#include <taut/options.hpp>

namespace taut::python
{

/// Where a call stands.
struct call_progress
{
    std::string stage;
    int iteration = 0; ///< accepted steps so far; of an atlas: charts that are done
    int level = 0;
    double value = std::numeric_limits<double>::quiet_NaN();
    double gradient = std::numeric_limits<double>::quiet_NaN();
    double seconds = 0;
    bool usable = false; ///< a call that ends now has a result
    long told = 0;       ///< counts
};

/// What the thread of a call and those who watch it have in common. Any thread may use it.
class control : public std::enable_shared_from_this<control>
{
public:
    /// Ends the call at its next question.
    void stop() noexcept { stop_ = true; }
    bool stopped() const noexcept { return stop_; }

    /// The same, for another thread: the call ends as cancelled.
    void cancel() noexcept { cancelled_ = stop_ = true; }
    bool cancelled() const noexcept { return cancelled_; }

    call_progress last() const
    {
        const std::lock_guard lock(mutex_);
        return last_;
    }

    /// For the parameters of calls; stage: where the call names none. It keeps this object.
    taut::observer observer(std::string stage)
    {
        return [self = shared_from_this(), stage = std::move(stage)](const progress& p)
        {
            if (p.iterate)
                self->tell({p.stage.empty() ? stage : std::string(p.stage), p.iteration, p.level, p.value, p.gradient,
                            p.seconds, p.usable});
            return !self->stopped();
        };
    }

private:
    void tell(call_progress p)
    {
        const std::lock_guard lock(mutex_);
        p.told = last_.told + 1;
        last_ = std::move(p);
    }

    mutable std::mutex mutex_;
    call_progress last_;
    std::atomic<bool> stop_{false}, cancelled_{false};
};

} // namespace taut::python
