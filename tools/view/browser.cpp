// SPDX-License-Identifier: MIT
#include "view/browser.hpp"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <taut/files.hpp>

#include "view/leading_page.hpp"

extern char** environ;

namespace taut::view
{

namespace
{

void write_private(const std::filesystem::path& path, const std::string& text)
{
    const io::impl::descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    if (!file || ::write(*file, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
        throw std::system_error(errno, std::generic_category(), path.string());
}

/// xdg-open with nothing of ours but the streams, and in a group of its own: who ends us ends no browser. 0: there is
/// none.
pid_t open_with_desktop(std::string path)
{
    std::string program = "xdg-open";
    char* const arguments[] = {program.data(), path.data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t state;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    ::posix_spawnattr_init(&state);
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    ::posix_spawnattr_setsigmask(&state, &none);
    ::posix_spawnattr_setsigdefault(&state, &usual);
    ::posix_spawnattr_setflags(&state, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    pid_t process = 0;
    const int failure = ::posix_spawnp(&process, program.c_str(), &files, &state, arguments, environ);
    ::posix_spawnattr_destroy(&state);
    ::posix_spawn_file_actions_destroy(&files);
    return failure == 0 ? process : 0;
}

} // namespace

browser::browser(const std::string& url)
{
    const auto path = folder_.path() / "open.html";
    write_private(path, page_that_leads_to(url));
    process_ = open_with_desktop(path.string());
}

void browser::look() noexcept
{
    if (process_ != 0 && ::waitpid(process_, nullptr, WNOHANG) != 0) process_ = 0;
}

} // namespace taut::view
