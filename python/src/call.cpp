// SPDX-License-Identifier: MIT
#include "call.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <nanobind/stl/string.h>

namespace taut::python
{

struct handover
{
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::exception_ptr error;
};

namespace
{

using clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// Between looks for signals, for which other threads of Python have to give up the interpreter's lock: on processors
/// that are busy they get it back late.
constexpr auto interval_of_looks = 80ms;

struct left_work
{
    std::thread thread;
    std::shared_ptr<handover> state;
};

/// Never destroyed: threads may outlive all else.
std::list<left_work>& left()
{
    static auto* list = new std::list<left_work>;
    return *list;
}

/// Calls that are under way, to be ended before the interpreter is: a thread that it ends in the middle of one would
/// end the program. Never destroyed, and for those alone who have the interpreter's lock.
struct calls_under_way
{
    std::list<std::shared_ptr<control>> watched;
    bool closed = false;
};

calls_under_way& under_way()
{
    static auto* calls = new calls_under_way;
    return *calls;
}

/// Adds a call to those while it lives.
class listed
{
public:
    explicit listed(const std::shared_ptr<control>& c)
    {
        if (under_way().closed) throw std::runtime_error("the interpreter is ending");
        under_way().watched.push_front(c);
        place_ = under_way().watched.begin();
    }
    listed(const listed&) = delete;
    listed& operator=(const listed&) = delete;
    ~listed() { under_way().watched.erase(place_); }

private:
    std::list<std::shared_ptr<control>>::iterator place_;
};

void forget_ended()
{
    std::erase_if(left(),
                  [](left_work& w)
                  {
                      {
                          const std::lock_guard lock(w.state->mutex);
                          if (!w.state->done) return false;
                      }
                      w.thread.join();
                      return true;
                  });
}

/// What the thread that waits knows: whether somebody wants an end, and by when.
class watch
{
public:
    watch(const std::shared_ptr<control>& watched, nb::handle progress) : watched_(watched), progress_(progress) {}

    ending how = ending::finished;
    std::optional<nb::python_error> raised;

    /// With the interpreter's lock: signals, cancellation, progress.
    void look()
    {
        if (PyErr_CheckSignals() != 0) take_error();
        if (watched_->cancelled() && how == ending::finished)
        {
            how = ending::cancelled;
            end();
        }
        if (how == ending::finished && !raised && !progress_.is_none() && clock::now() - told_at_ >= 100ms) tell();
    }

    bool late() const { return deadline_ && clock::now() >= *deadline_; }

private:
    void take_error()
    {
        nb::python_error error;
        if (error.matches(PyExc_KeyboardInterrupt))
            how = ending::interrupted;
        else if (!raised)
            raised.emplace(std::move(error));
        end();
    }

    void tell()
    {
        const call_progress p = watched_->last();
        if (p.told == told_) return;
        told_ = p.told;
        told_at_ = clock::now();
        try
        {
            const nb::object answer = progress_(nb::cast(p));
            if (answer.is(nb::handle(Py_False))) watched_->stop();
        }
        catch (nb::python_error& e)
        {
            if (e.matches(PyExc_KeyboardInterrupt))
                how = ending::interrupted;
            else
                raised.emplace(std::move(e));
            end();
        }
    }

    void end()
    {
        watched_->stop();
        if (!deadline_) deadline_ = clock::now() + 400ms;
    }

    std::shared_ptr<control> watched_;
    nb::handle progress_;
    long told_ = 0;
    clock::time_point told_at_ = clock::now() - 1s;
    std::optional<clock::time_point> deadline_;
};

} // namespace

ending run_work(const std::shared_ptr<control>& watched, nb::handle progress, std::function<void()> work,
                std::shared_ptr<handover>& left_alone)
{
    forget_ended();
    const listed call(watched);
    auto state = std::make_shared<handover>();
    std::thread worker(
        [state, work = std::move(work)]() mutable
        {
            std::exception_ptr error;
            try
            {
                work();
            }
            catch (...)
            {
                error = std::current_exception();
            }
            work = nullptr; // frees what it owns before anyone hears of the end
            const std::lock_guard lock(state->mutex);
            state->error = error;
            state->done = true;
            state->changed.notify_all();
        });
    watch watching(watched, progress);
    for (bool done = false; !done;)
    {
        {
            nb::gil_scoped_release unlocked;
            const auto next = clock::now() + interval_of_looks;
            std::unique_lock lock(state->mutex);
            // A cancellation is seen without the interpreter's lock.
            for (bool wanted = false; !done && !wanted && clock::now() < next;)
            {
                done = state->changed.wait_for(lock, 20ms, [&] { return state->done; });
                wanted = watched->cancelled() && watching.how == ending::finished;
            }
        }
        if (!done) watching.look();
        if (!done && watching.late())
        {
            left().push_back({std::move(worker), state});
            left_alone = state;
            break;
        }
    }
    if (worker.joinable()) worker.join();
    if (watching.raised) throw std::move(*watching.raised);
    const std::lock_guard lock(state->mutex);
    if (state->done && state->error && watching.how == ending::finished) std::rethrow_exception(state->error);
    return watching.how;
}

bool has_ended_well(handover& left)
{
    for (bool done = false; !done;)
    {
        {
            nb::gil_scoped_release unlocked;
            std::unique_lock lock(left.mutex);
            done = left.changed.wait_for(lock, interval_of_looks, [&] { return left.done; });
        }
        if (!done && PyErr_CheckSignals() != 0) throw nb::python_error();
    }
    const std::lock_guard lock(left.mutex);
    return !left.error;
}

void join_left_work()
{
    const auto deadline = clock::now() + 10s;
    under_way().closed = true;
    while (!under_way().watched.empty() && clock::now() < deadline)
    {
        for (const auto& c : under_way().watched) c->cancel();
        nb::gil_scoped_release unlocked;
        std::this_thread::sleep_for(10ms);
    }
    nb::gil_scoped_release unlocked;
    for (auto& w : left())
    {
        std::unique_lock lock(w.state->mutex);
        const bool done = w.state->changed.wait_until(lock, deadline, [&] { return w.state->done; });
        lock.unlock();
        if (done)
            w.thread.join();
        else
            w.thread.detach();
    }
    left().clear();
}

bool work_is_left()
{
    forget_ended();
    return !left().empty();
}

void add_control(nb::module_& m)
{
    nb::class_<call_progress>(m, "Progress", "Where a call stands.")
        .def_ro("stage", &call_progress::stage, "What is being done.")
        .def_ro("iteration", &call_progress::iteration, "Accepted steps so far; of an atlas: charts that are done.")
        .def_ro("level", &call_progress::level, "Of the hierarchy; 0 is the mesh itself.")
        .def_ro("value", &call_progress::value, "The energy, or how much of the squares is used.")
        .def_ro("gradient", &call_progress::gradient, "Its relative gradient.")
        .def_ro("seconds", &call_progress::seconds, "Since the start.")
        .def_ro("usable", &call_progress::usable, "Whether a call that ends now has a result.")
        .def("__repr__", [](const call_progress& p)
             { return "Progress(" + p.stage + ", iteration " + std::to_string(p.iteration) + ")"; });
    nb::class_<control_handle>(m, "Control", "Watches a call and ends it, from any thread.")
        .def(nb::init<>())
        .def("cancel", [](control_handle& c) { c.shared->cancel(); })
        .def("stop", [](control_handle& c) { c.shared->stop(); })
        .def_prop_ro("cancelled", [](const control_handle& c) { return c.shared->cancelled(); })
        .def_prop_ro("progress", [](const control_handle& c) { return c.shared->last(); });
    m.def("work_is_left", &work_is_left);
    m.def("join_left_work", &join_left_work);
}

} // namespace taut::python
