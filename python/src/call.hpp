// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <nanobind/nanobind.h>

#include "control.hpp"

namespace taut::python
{

namespace nb = nanobind;

/// How a call ended.
enum class ending
{
    finished,
    interrupted, ///< by Ctrl-C
    cancelled    ///< by control::cancel()
};

/// What the thread of a call tells the one that waits.
struct handover;

/// Runs `work` on a thread of its own, while the calling thread waits without the interpreter's lock, looks for signals
/// and calls `progress`, if that is not None, at most ten times a second: an answer of False ends the work. After a
/// signal or a cancellation the work has 0.4 s to end with a result; then it is left alone, to end by itself, and
/// `left` is what it will tell. The work owns all it uses, none of it objects of the interpreter. Rethrows what the
/// work throws, and what `progress` or the handler of a signal other than Ctrl-C raises.
ending run_work(const std::shared_ptr<control>& watched, nb::handle progress, std::function<void()> work,
                std::shared_ptr<handover>& left);

/// With the interpreter's lock, which it gives up: waits for work that was left alone; false: it failed. Throws what
/// the handler of a signal raises.
bool has_ended_well(handover& left);

/// What Python calls Control.
struct control_handle
{
    std::shared_ptr<control> shared = std::make_shared<control>();
};

/// The ending, and what the work returns if it came to that, or will return if it was left alone.
template <class Result>
struct outcome_of
{
    ending how = ending::finished;
    std::shared_ptr<std::optional<Result>> value;
    std::shared_ptr<handover> left;
};

template <class Work>
auto run(const std::shared_ptr<control>& watched, nb::handle progress, Work work)
{
    using result = decltype(work());
    auto kept = std::make_shared<std::optional<result>>();
    std::shared_ptr<handover> left;
    const ending how = run_work(
        watched, progress, [kept, work = std::move(work)]() mutable { kept->emplace(work()); }, left);
    return outcome_of<result>{how, std::move(kept), std::move(left)};
}

/// "finished", "interrupted" or "cancelled"; what `convert` makes of the result, or None; and of work that was left
/// alone a function that waits for it and returns the same, else None. `convert` owns all it uses.
template <class Result, class Convert>
nb::object told(outcome_of<Result> found, Convert convert)
{
    const char* how = found.how == ending::finished      ? "finished"
                      : found.how == ending::interrupted ? "interrupted"
                                                         : "cancelled";
    const auto take = [value = found.value, convert]() -> nb::object
    {
        if (!*value) return nb::none();
        Result made = std::move(**value);
        value->reset();
        return convert(std::move(made));
    };
    if (!found.left) return nb::make_tuple(how, take(), nb::none());
    const auto later = [left = found.left, take]() -> nb::object
    { return has_ended_well(*left) ? take() : nb::object(nb::none()); };
    return nb::make_tuple(how, nb::none(), nb::cpp_function(later));
}

/// Cancels all calls and waits for them, and for work that was left alone, some seconds at most: before the interpreter
/// ends.
void join_left_work();

/// Whether there is such work.
bool work_is_left();

void add_control(nb::module_& m);

} // namespace taut::python
