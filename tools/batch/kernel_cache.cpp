// SPDX-License-Identifier: MIT
#include "batch/kernel_cache.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <taut/impl/core/compute/program/private_folder.hpp>

#include "shared/failure.hpp"

namespace taut::tools::batch
{

namespace fs = std::filesystem;

namespace
{

void make_private(const fs::path& folder)
{
    if (const auto fault = impl::fault_of_made_folder(folder); !fault.empty())
        throw usage_error("--cache " + folder.string() + ": " + fault + "; name another folder");
}

} // namespace

fs::path default_caches()
{
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host = {'h', 'e', 'r', 'e'};
    // A home may be that of many machines.
    const auto own = [&](const fs::path& base) { return base / "taut-batch" / host.data(); };
    const auto variable = [](const char* name) -> std::string
    {
        const char* value = std::getenv(name);
        return value ? value : "";
    };
    if (const auto named = variable("POCL_CACHE_DIR"); !named.empty()) return own(named);
    if (const auto caches = variable("XDG_CACHE_HOME"); !caches.empty()) return own(caches);
    if (const auto home = variable("HOME"); !home.empty()) return own(fs::path(home) / ".cache");
    throw usage_error("there is no HOME to keep compiled kernels in; name a folder with --cache");
}

kernel_cache::kernel_cache(const fs::path& caches)
{
    const auto refuse = [&](int number)
    {
        throw usage_error("--cache " + caches.string() + ": " + std::generic_category().message(number) +
                          "; name another folder");
    };
    make_private(caches);
    for (int k = 0;; ++k)
    {
        folder_ = caches / std::to_string(k);
        const auto lock = caches / (std::to_string(k) + ".lock");
        lock_ = io::impl::descriptor(::open(lock.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
        if (!lock_ && (errno == EMFILE || errno == ENFILE))
            throw std::system_error(errno, std::generic_category(), "no kernel cache");
        if (!lock_) refuse(errno);
        if (::flock(*lock_, LOCK_EX | LOCK_NB) == 0) break;
        if (errno != EWOULDBLOCK && errno != EINTR) refuse(errno);
    }
    make_private(folder_);
}

} // namespace taut::tools::batch
