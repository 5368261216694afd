// SPDX-License-Identifier: MIT
#include "shared/standard_streams.hpp"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <shellapi.h>
#else
#include <csignal>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#endif

namespace taut::tools
{

#if defined(_WIN32)

namespace
{

std::string in_utf8(const wchar_t* text)
{
    const int size = ::WideCharToMultiByte(CP_UTF8, 0, text, -1, nullptr, 0, nullptr, nullptr); // with its 0
    std::string bytes(size > 0 ? static_cast<std::size_t>(size) : 1, '\0');
    ::WideCharToMultiByte(CP_UTF8, 0, text, -1, bytes.data(), size, nullptr, nullptr);
    bytes.pop_back();
    return bytes;
}

/// What takes off the bar of progress is a sequence of a terminal.
void understand_sequences(DWORD stream)
{
    DWORD mode = 0;
    const HANDLE terminal = ::GetStdHandle(stream);
    if (::GetConsoleMode(terminal, &mode)) ::SetConsoleMode(terminal, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

} // namespace

void prepare_streams()
{
    for (const int number : {0, 1, 2}) ::_setmode(number, _O_BINARY);
    ::SetConsoleOutputCP(CP_UTF8);
    understand_sequences(STD_OUTPUT_HANDLE);
    understand_sequences(STD_ERROR_HANDLE);
}

std::vector<std::string> words_of(int argc, char** argv)
{
    int count = 0;
    wchar_t** wide = ::CommandLineToArgvW(::GetCommandLineW(), &count);
    if (wide == nullptr) return {argv, argv + argc};
    std::vector<std::string> words;
    for (int k = 0; k < count; ++k) words.push_back(in_utf8(wide[k]));
    ::LocalFree(wide);
    return words;
}

bool has_reader(int) noexcept
{
    return true; // it shows where it is written
}

#else

void prepare_streams()
{
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(number, F_GETFD) < 0 && ::open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
            break; // then nothing can be opened at all
    std::signal(SIGPIPE, SIG_IGN);
}

std::vector<std::string> words_of(int argc, char** argv)
{
    return {argv, argv + argc};
}

bool has_reader(int number) noexcept
{
    pollfd stream = {number, POLLOUT, 0};
    return ::poll(&stream, 1, 0) < 1 || (stream.revents & (POLLERR | POLLHUP)) == 0;
}

#endif

} // namespace taut::tools
