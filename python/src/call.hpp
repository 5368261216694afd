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

/// Runs `work` on a thread of its own, while the calling thread waits without the interpreter's lock, looks for signals
/// and calls `progress`, if that is not None, at most ten times a second: an answer of False ends the work. After a
/// signal or a cancellation the work has 0.4 s to end with a result; then it is left alone, to end by itself. The work
/// owns all it uses, none of it objects of the interpreter. Rethrows what the work throws, and what `progress` or the
/// handler of a signal other than Ctrl-C raises.
ending run_work(const std::shared_ptr<control>& watched, nb::handle progress, std::function<void()> work);

/// What Python calls Control.
struct control_handle
{
    std::shared_ptr<control> shared = std::make_shared<control>();
};

/// The ending, and what the work returns if it came to that.
template <class Result>
struct outcome_of
{
    ending how = ending::finished;
    std::optional<Result> value;
};

template <class Work>
auto run(const std::shared_ptr<control>& watched, nb::handle progress, Work work)
{
    using result = decltype(work());
    auto kept = std::make_shared<std::optional<result>>();
    const ending how = run_work(watched, progress, [kept, work = std::move(work)]() mutable { kept->emplace(work()); });
    outcome_of<result> found{how, std::nullopt};
    // Work that was left alone still writes there.
    if (kept.use_count() == 1 && *kept) found.value = std::move(*kept);
    return found;
}

/// "finished", "interrupted" or "cancelled", and what `convert` makes of the result, or None.
template <class Result, class Convert>
nb::object told(outcome_of<Result> found, const Convert& convert)
{
    const char* how = found.how == ending::finished      ? "finished"
                      : found.how == ending::interrupted ? "interrupted"
                                                         : "cancelled";
    nb::object value = nb::none();
    if (found.value) value = convert(std::move(*found.value));
    return nb::make_tuple(how, value);
}

/// Cancels all calls and waits for them, and for work that was left alone, some seconds at most: before the interpreter
/// ends.
void join_left_work();

/// Whether there is such work.
bool work_is_left();

void add_control(nb::module_& m);

} // namespace taut::python
