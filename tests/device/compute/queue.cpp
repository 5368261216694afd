// SPDX-License-Identifier: MIT
#include <future>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <doctest/doctest.h>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/queue_state.hpp>
#include <taut/kernel.hpp>

#include "support/device.hpp"
#include "support/opencl.hpp"

namespace
{

const char* const twice = "__kernel void twice(__global float* x) { x[get_global_id(0)] *= 2; }";

void run_twice(taut::queue& q)
{
    taut::buffer<float> x(q, std::vector<float>(64, 1.5f));
    q.kernel<taut::buffer<float>>(twice, "twice")(64, x);
    CHECK(x.download() == std::vector<float>(64, 3.0f));
}

} // namespace

TEST_CASE("queue: on the best device")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q;
    run_twice(q);
    std::ostringstream text;
    text << q;
    CHECK(text.str().find(q.device().name()) != std::string::npos);
}

TEST_CASE("queue: copies share context, cache and counters; other queues do not")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q, other;
    taut::queue copy = q;
    CHECK(copy == q);
    CHECK(!(other == q));
    run_twice(copy);
    CHECK(q.counters().launches == 1);
    CHECK(other.counters().launches == 0);
}

TEST_CASE("queue: a second thread is told whose queue it is")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q;
    taut::buffer<float> x(q, std::vector<float>(64, 1.0f));
    std::promise<void> entered, tried;
    std::thread first(
        [&]
        {
            const auto use = taut::impl::state_of(q)->enter(); // as in the middle of a build
            entered.set_value();
            tried.get_future().wait();
        });
    entered.get_future().wait();
    const auto scale = [&] { q.kernel<taut::buffer<float>>(twice, "twice")(64, x); };
    CHECK_THROWS_WITH_AS(scale(), doctest::Contains("another thread is using it now"), taut::device_error);
    CHECK_THROWS_AS(x.download(), taut::device_error);
    CHECK_THROWS_AS(q.finish(), taut::device_error);
    tried.set_value();
    first.join();
    run_twice(q); // one after the other is fine

    std::thread second([&] { run_twice(q); });
    second.join();
}

#if defined(__unix__) || defined(__APPLE__)
TEST_CASE("queue: a child that fork() has made is told that it cannot go on with OpenCL, and ends")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q;
    taut::buffer<float> x(q, std::vector<float>(64, 1.0f));
    const auto refused = [](const auto& call)
    {
        try
        {
            call();
            return false;
        }
        catch (const taut::device_error& e)
        {
            return std::string(e.what()).find("fork before the first queue") != std::string::npos;
        }
    };
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
        ::alarm(60); // it must not wait for ever
        bool told = refused([&] { q.finish(); }) && refused([&] { x.download(); }) &&
                    refused([] { taut::queue another; }) && refused([] { taut::devices(); });
        {
            const taut::queue last = std::move(q);
            x = taut::buffer<float>();
        }
        ::_exit(told ? 0 : 1);
    }
    int status = -1;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    run_twice(q); // the parent's is as it was
}
#endif

#if defined(__unix__) || defined(__APPLE__)
TEST_CASE("queue: a child that fork() has made goes on with the host")
{
    taut::queue q(taut::device::host());
    taut::buffer<double> x(q, std::vector<double>(100000, 1.0));
    const auto twice_on_host = [&]
    {
        q.submit(
            [&](taut::handler& h)
            {
                const auto y = x.read_write(h);
                h.parallel_for(x.size(), [=](auto i) { y[i] *= 2; });
            });
        return x.download();
    };
    CHECK(twice_on_host() == std::vector<double>(x.size(), 2.0));
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
        ::alarm(60); // it must not wait for ever
        const bool right = twice_on_host() == std::vector<double>(x.size(), 4.0) &&
                           taut::queue(taut::find_device("host")).device().is_host();
        ::_exit(right ? 0 : 1);
    }
    int status = -1;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}
#endif

TEST_CASE("queue: a user's context and command queue are adopted and keep working afterwards")
{
    if (!taut::test::compiles_text()) return;
    const cl_device_id id = taut::find_device().native();
    cl_int code = 0;
    const cl_context context = taut::test::cl().clCreateContext(nullptr, 1, &id, nullptr, nullptr, &code);
    REQUIRE(code == CL_SUCCESS);
    const cl_command_queue commands = taut::test::cl().clCreateCommandQueue(context, id, 0, &code);
    REQUIRE(code == CL_SUCCESS);
    {
        taut::queue in_context(context);
        CHECK(in_context.native_context() == context);
        run_twice(in_context);

        taut::queue through(commands);
        CHECK(through.native() == commands);
        CHECK(through.device() == in_context.device());
        run_twice(through);
    }
    CHECK(taut::test::cl().clFinish(commands) == CL_SUCCESS);
    taut::test::cl().clReleaseCommandQueue(commands);
    taut::test::cl().clReleaseContext(context);
}

TEST_CASE("queue: an out-of-order command queue is refused, since commands rely on their order")
{
    if (!taut::test::compiles_text()) return;
    const cl_device_id id = taut::find_device().native();
    cl_int code = 0;
    const cl_context context = taut::test::cl().clCreateContext(nullptr, 1, &id, nullptr, nullptr, &code);
    const cl_command_queue commands =
        taut::test::cl().clCreateCommandQueue(context, id, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, &code);
    if (code == CL_SUCCESS)
    {
        CHECK_THROWS_AS(taut::queue{commands}, taut::device_error);
        taut::test::cl().clReleaseCommandQueue(commands);
    }
    taut::test::cl().clReleaseContext(context);
}

TEST_CASE("queue: counters tell launches, waits, bytes and builds")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q;
    taut::buffer<double> x(q, 32);
    x.upload(std::vector<double>(32, 1.0));
    const auto before = q.counters();
    CHECK(before.waits == 1);
    CHECK(before.bytes_written == 256);
    CHECK(before.launches == 0);

    const auto k = q.kernel<taut::buffer<double>>("#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n__kernel void "
                                                  "one(__global double* x) { x[get_global_id(0)] = 1; }",
                                                  "one");
    k(32, x);
    k(32, x);
    x.fill(3);
    CHECK(q.counters().waits == 1);
    CHECK(q.counters().launches == 2);
    CHECK(q.counters().builds == 1);
    CHECK(q.counters().build_seconds > 0);
    x.download();
    q.finish();
    CHECK(q.counters().waits == 3);
    CHECK(q.counters().bytes_read == 256);
}

TEST_CASE("queue: events complete, and tell the time where the queue profiles")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::find_device(), {.profiling = true});
    taut::buffer<float> x(q, std::vector<float>(64, 1.0f));
    const taut::event e = q.kernel<taut::buffer<float>>(twice, "twice")(64, x);
    e.wait();
    CHECK(e.complete());
    REQUIRE(e.seconds().has_value());
    CHECK(*e.seconds() >= 0);

    const taut::event none;
    none.wait();
    CHECK(none.complete());
    CHECK(!none.seconds().has_value());
}

TEST_CASE("queue: a dead handle of the user's is a device_error")
{
    if (!taut::test::compiles_text()) return;
    CHECK_THROWS_AS(taut::queue(static_cast<cl_context>(nullptr)), taut::device_error);
    CHECK_THROWS_AS(taut::queue(static_cast<cl_command_queue>(nullptr)), taut::device_error);
}
