// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <taut/queue.hpp>

namespace taut
{

/// A command on its way, of one model of device_commands.
class event::state
{
public:
    virtual ~state() = default;
    virtual void wait() const {}
    virtual bool complete() const { return true; }
    virtual std::optional<double> seconds() const = 0;
    virtual cl_event native() const { return nullptr; }
};

} // namespace taut
