// SPDX-License-Identifier: MIT
#include "shared/child.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace taut::tools
{

namespace
{

constexpr std::size_t most_kept = 1 << 16; // of what a child says

std::vector<char*> pointers_to(std::vector<std::string>& texts)
{
    std::vector<char*> all;
    for (auto& text : texts) all.push_back(text.data());
    all.push_back(nullptr);
    return all;
}

std::pair<io::impl::descriptor, io::impl::descriptor> make_pipe()
{
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "no pipe");
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    return {io::impl::descriptor(ends[0]), io::impl::descriptor(ends[1])};
}

/// A file without a name, to be read from its beginning.
io::impl::descriptor file_of(const std::string& text)
{
    io::impl::descriptor file(::memfd_create("taut", MFD_CLOEXEC));
    for (std::size_t at = 0; file && at < text.size();)
    {
        const auto written = ::write(*file, text.data() + at, text.size() - at);
        if (written < 0) throw std::system_error(errno, std::generic_category(), "no memory for a file");
        at += static_cast<std::size_t>(written);
    }
    if (!file || ::lseek(*file, 0, SEEK_SET) != 0) throw std::system_error(errno, std::generic_category(), "no file");
    return file;
}

/// In the child between fork and exec, where nothing but plain system calls is safe.
[[noreturn]] void become(char* const* args, char* const* environment, int in, int out, int err, rlim_t memory,
                         pid_t parent)
{
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127); // it was over before that
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    const rlimit none{0, 0}, data{memory, memory};
    ::setrlimit(RLIMIT_CORE, &none);
    if (memory != RLIM_INFINITY) ::setrlimit(RLIMIT_DATA, &data);
    sigset_t all;
    sigemptyset(&all);
    ::sigprocmask(SIG_SETMASK, &all, nullptr);
    ::syscall(SYS_close_range, STDERR_FILENO + 1, ~0U, 0); // whatever libraries have opened, too
    ::execve("/proc/self/exe", args, environment);
    ::_exit(127);
}

} // namespace

std::vector<std::string> environment()
{
    std::vector<std::string> all;
    for (char** one = environ; *one; ++one) all.emplace_back(*one);
    return all;
}

child::child(const std::vector<std::string>& args, const std::vector<std::string>& environment, const limits& bounds,
             const std::string& input)
    : bounds_(bounds)
{
    std::vector<std::string> all = {"taut"}, variables = environment;
    all.insert(all.end(), args.begin(), args.end());
    const auto arguments = pointers_to(all), values = pointers_to(variables);
    const auto in = file_of(input);
    auto [out, out_end] = make_pipe();
    auto [err, err_end] = make_pipe();
    // A fence for what grows faster than somebody looks: allocations beyond it fail.
    const rlim_t fence = bounds.memory < RLIM_INFINITY / 2 ? 2 * bounds.memory : RLIM_INFINITY;
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ < 0) throw std::system_error(errno, std::generic_category(), "no process");
    if (process_ == 0) become(arguments.data(), values.data(), *in, *out_end, *err_end, fence, parent);
    streams_ = {std::move(out), std::move(err)};
    over_ = io::impl::descriptor(static_cast<int>(::syscall(SYS_pidfd_open, process_, 0)));
}

child::~child()
{
    if (process_ == 0) return;
    kill_all();
    ::waitpid(process_, nullptr, 0);
}

std::array<pollfd, 3> child::news() const noexcept
{
    return {{{*streams_[0], POLLIN, 0}, {*streams_[1], POLLIN, 0}, {*over_, POLLIN, 0}}}; // -1 is left out
}

std::optional<child_end> child::look()
{
    drain(0);
    drain(1);
    siginfo_t state = {};
    if (::waitid(P_PID, static_cast<id_t>(process_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 && state.si_pid != 0)
    {
        kill_all(); // what it may have left behind, while its number is nobody else's
        int status = 0;
        rusage used = {};
        ::wait4(std::exchange(process_, 0), &status, 0, &used);
        drain(0);
        drain(1);
        const auto in_seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * double(t.tv_usec); };
        child_end end;
        end.by = by_;
        end.seconds = seconds();
        end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        end.code = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(status);
        end.cpu_seconds = in_seconds(used.ru_utime) + in_seconds(used.ru_stime);
        end.peak_memory = static_cast<std::uint64_t>(used.ru_maxrss) * 1024; // Linux counts KiB
        end.printed = std::move(said_[0]);
        end.complaints = std::move(said_[1]);
        return end;
    }
    if (resident() > bounds_.memory)
    {
        by_ = child_end::memory_limit;
        kill_all();
    }
    else if (seconds() > killed_at_)
        kill_all();
    else if (seconds() > bounds_.seconds)
        ask(SIGTERM, child_end::time_limit);
    return std::nullopt;
}

void child::stop(int signal) noexcept
{
    ask(signal, child_end::asked);
}

void child::ask(int signal, child_end::cause why) noexcept
{
    if (by_ != child_end::itself) return;
    by_ = why;
    killed_at_ = seconds() + bounds_.grace;
    ::kill(process_, signal); // it alone: programs that an OpenCL driver has started are to finish
}

void child::kill_all() const noexcept
{
    ::kill(process_, SIGKILL); // it may not have its group yet
    ::kill(-process_, SIGKILL);
}

std::uint64_t child::resident() const noexcept
{
    std::array<char, 32> name{};
    std::array<char, 128> text{};
    std::snprintf(name.data(), name.size(), "/proc/%d/statm", static_cast<int>(process_));
    const io::impl::descriptor file(::open(name.data(), O_RDONLY | O_CLOEXEC));
    unsigned long long size = 0, pages = 0;
    if (!file || ::read(*file, text.data(), text.size() - 1) <= 0) return 0;
    if (std::sscanf(text.data(), "%llu %llu", &size, &pages) != 2) return 0;
    static const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return pages * page;
}

void child::drain(std::size_t stream)
{
    std::array<char, 1 << 14> piece;
    auto& said = said_[stream];
    if (!streams_[stream]) return;
    for (int k = 0; k < 64; ++k) // who never stops talking must not keep others waiting
    {
        const auto got = ::read(*streams_[stream], piece.data(), piece.size());
        if (got == 0) streams_[stream] = io::impl::descriptor();
        if (got <= 0) return;
        said.append(piece.data(), static_cast<std::size_t>(got));
        if (said.size() > 2 * most_kept) said.erase(0, said.size() - most_kept);
    }
}

} // namespace taut::tools
