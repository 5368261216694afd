// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include "../../../tools/exit_codes.hpp"
#include "../../../tools/interrupt.hpp"

using taut::tools::exit_code;
using taut::tools::interrupt_guard;

TEST_CASE("interrupt: the first Ctrl-C only sets the flag, a new guard starts afresh")
{
    {
        const interrupt_guard guard;
        CHECK(!guard.requested());
        std::raise(SIGINT);
        CHECK(guard.requested());
    }
    const interrupt_guard next;
    CHECK(!next.requested());
}

TEST_CASE("interrupt: the second Ctrl-C kills")
{
    const pid_t child = fork();
    if (child == 0)
    {
        const interrupt_guard guard;
        std::raise(SIGINT);
        if (!guard.requested()) _exit(1);
        std::raise(SIGINT);
        _exit(2);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
}

TEST_CASE("interrupt: the handling of before is back afterwards")
{
    struct sigaction before = {}, after = {};
    sigaction(SIGINT, nullptr, &before);
    {
        const interrupt_guard guard;
    }
    sigaction(SIGINT, nullptr, &after);
    CHECK((before.sa_handler == after.sa_handler));
}

TEST_CASE("exit codes: the documented numbers")
{
    CHECK(to_int(exit_code::valid) == 0);
    CHECK(to_int(exit_code::usage) == 2);
    CHECK(to_int(exit_code::unreadable_input) == 3);
    CHECK(to_int(exit_code::unsuitable_input) == 4);
    CHECK(to_int(exit_code::no_device) == 5);
    CHECK(to_int(exit_code::no_valid_map) == 6);
    CHECK(to_int(exit_code::time_limit) == 8);
    CHECK(to_int(exit_code::device_failure) == 9);
    CHECK(to_int(exit_code::interrupted) == 130);
}
