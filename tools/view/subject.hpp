// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "view/messages.hpp"

namespace taut::view
{

/// Subject of a page: a map of a surface, or a shape. Called from one thread.
class subject
{
public:
    virtual ~subject() = default;

    virtual view::model model() const = 0;

    /// These throw what the library does, and nothing has changed.
    virtual void pin(std::span<const place> pins) = 0;
    virtual void release(std::span<const std::int32_t> vertices) = 0;
    virtual void focus(std::span<const std::int32_t> faces) = 0;
    virtual void align(int axis, std::span<const std::int32_t> vertices) = 0;
    virtual void start_afresh() = 0;
    virtual void pose(const ask::pose& to) = 0;
    virtual void move(const ask::move& to) = 0;
    virtual void keep() = 0;

    /// Another number where there is another model.
    virtual int revision() const = 0;

    /// Does what makes drivers compile late, so that no one at the page waits for it; nothing has changed.
    virtual void rehearse() = 0;

    /// Goes on for some milliseconds, and at least for a step, unless goes_on() says no: then what there is will do.
    /// Whether there is more to gain.
    virtual bool advance(std::chrono::duration<double> time, const std::function<bool()>& goes_on) = 0;

    /// Energy, pins, positions and whether it has converged; what is about the workbench stays as it is.
    virtual void describe(state& s) const = 0;

    /// All that undo brings back.
    class memory
    {
    public:
        virtual ~memory() = default;
        virtual std::size_t bytes() const = 0; ///< that are kept for it alone
    };
    virtual std::shared_ptr<const memory> remember() const = 0;
    virtual void go_back(const memory& before) = 0;

    /// The name and the bytes of the file that `taut` would write, and what there is to tell of it.
    struct saved
    {
        std::string name, bytes;
        std::vector<std::string> notes = {};
    };
    virtual saved write() const = 0; ///< throws where `taut` would write none
};

} // namespace taut::view
