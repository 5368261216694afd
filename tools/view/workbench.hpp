// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "view/messages.hpp"
#include "view/subject.hpp"

namespace taut::view
{

/// A subject at work on a thread of its own: it grants wishes as they come, goes on until it has converged, and rests.
/// A wish that comes while it goes on ends the step at hand.
class workbench
{
public:
    /// All are called from its thread.
    struct listener
    {
        std::function<void(std::shared_ptr<const state>)> show; ///< each state, the first one included
        std::function<void(std::string)> tell;                  ///< notes and files, encoded
        std::function<void(std::string)> open;                  ///< another model, encoded, before its first state
    };

    /// frame: how long the subject goes on before a state is shown.
    workbench(std::unique_ptr<subject> what, listener who, std::chrono::duration<double> frame);
    workbench(const workbench&) = delete;
    workbench& operator=(const workbench&) = delete;

    /// Ends after the step at hand.
    ~workbench();

    /// From any thread; false: so many wait that this one is not taken.
    bool wish(message m);

private:
    using moment = std::shared_ptr<const subject::memory>;

    void work();
    void grant(const message& m);
    void keep(moment before);
    void rehearse();
    bool is_asked();
    void go(std::deque<moment>& from, std::deque<moment>& to);
    void show(double seconds);

    const std::unique_ptr<subject> subject_;
    const listener listener_;
    const std::chrono::duration<double> frame_;

    std::deque<moment> before_, after_; ///< what undo and redo go to, the last ones first
    std::optional<std::uint32_t> gesture_;
    std::uint32_t number_ = 0;
    bool working_ = false;
    int revision_ = 0; ///< of the model that has been shown

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<message> inbox_;
    bool over_ = false;
    std::thread thread_; ///< last: all else is there when it begins
};

} // namespace taut::view
