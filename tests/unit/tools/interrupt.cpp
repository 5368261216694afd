// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <csignal>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../../../tools/shared/exit_codes.hpp"
#include "../../../tools/shared/interrupt.cpp" // it is not in a library of its own
#include "../../../tools/shared/stop_signals.cpp"

using namespace taut::tools;

namespace
{

/// The exit code of a process that watches for interrupts and runs f, -1 if it was killed. 42 if f returns.
template <class F>
int exit_code_of(F&& f)
{
    const pid_t child = ::fork();
    if (child == 0)
    {
        ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
        watch_interrupts();
        f();
        ::_exit(42);
    }
    int status = 0;
    if (::waitpid(child, &status, 0) != child) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void send(int signal)
{
    ::kill(::getpid(), signal);
}

template <class Condition>
void wait_for(Condition&& holds)
{
    for (int k = 0; k < 10000 && !holds(); ++k) ::usleep(1000);
}

void wait_for_the_end()
{
    wait_for([] { return false; });
}

} // namespace

TEST_CASE("interrupt: with nothing to keep, a signal ends the program at once")
{
    for (const auto& sent : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)})
    {
        const int signal = sent.first, code = sent.second; // clang 14 captures no structured bindings
        CHECK(exit_code_of(
                  [&]
                  {
                      send(signal);
                      wait_for_the_end();
                  }) == code);
        CHECK(exit_code_of(
                  [&]
                  {
                      keep(true);
                      keep(false);
                      send(signal);
                      wait_for_the_end();
                  }) == code);
    }
}

TEST_CASE("interrupt: with something to keep, the first signal asks and the second one ends the program")
{
    for (const auto& sent : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)})
    {
        const int signal = sent.first, code = sent.second; // clang 14 captures no structured bindings
        CHECK(exit_code_of(
                  [&]
                  {
                      keep(true);
                      if (interrupted()) ::_exit(1);
                      send(signal);
                      wait_for(interrupted);
                      if (!interrupted() || to_int(interruption()) != code) ::_exit(2);
                      keep(false); // too late to change it
                      if (!interrupted()) ::_exit(3);
                  }) == 42);
        CHECK(exit_code_of(
                  [&]
                  {
                      keep(true);
                      send(signal);
                      wait_for(interrupted);
                      send(signal);
                      wait_for_the_end();
                  }) == code);
        CHECK(exit_code_of(
                  [&]
                  {
                      keep(true);
                      send(signal);
                      wait_for(interrupted);
                      send(signal);
                      while (interrupted()) // until the other thread has ended the program
                      {
                      }
                  }) == code);
    }
}

TEST_CASE("interrupt: the handlers of others are not entered, nor do programs that were started notice")
{
    CHECK(exit_code_of(
              []
              {
                  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { ::_exit(1); });
                  keep(true);
                  send(SIGINT);
                  wait_for(interrupted);
                  const pid_t child = ::fork();
                  if (child == 0)
                  {
                      std::signal(SIGINT, SIG_DFL);
                      send(SIGINT);
                      ::_exit(7);
                  }
                  int status = 0;
                  if (::waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 7)
                      ::_exit(2);
              }) == 42);
}

TEST_CASE("interrupt: the time limit ends a program that has nothing to keep, and leaves another alone")
{
    CHECK(exit_code_of(
              []
              {
                  limit_time(1e-3);
                  wait_for_the_end();
              }) == to_int(exit_code::no_valid_map));
    CHECK(exit_code_of(
              []
              {
                  keep(true);
                  limit_time(0);
                  ::usleep(20000);
                  if (interrupted()) ::_exit(1);
              }) == 42);
    CHECK(exit_code_of([] { limit_time(std::numeric_limits<double>::infinity()); }) == 42);
}

TEST_CASE("exit codes: the documented numbers")
{
    CHECK(to_int(exit_code::valid) == 0);
    CHECK(to_int(exit_code::usage) == 2);
    CHECK(to_int(exit_code::unreadable_input) == 3);
    CHECK(to_int(exit_code::unsuitable_input) == 4);
    CHECK(to_int(exit_code::no_device) == 5);
    CHECK(to_int(exit_code::no_valid_map) == 6);
    CHECK(to_int(exit_code::infeasible) == 7);
    CHECK(to_int(exit_code::time_limit) == 8);
    CHECK(to_int(exit_code::device_failure) == 9);
    CHECK(to_int(exit_code::interrupted) == 130);
    CHECK(to_int(exit_code::terminated) == 143);
}
