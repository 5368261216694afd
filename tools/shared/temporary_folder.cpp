// SPDX-License-Identifier: MIT
#include "shared/temporary_folder.hpp"

#include <cstdlib>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <system_error>

#include <taut/errors.hpp>

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

std::mutex guard;
std::set<fs::path> living;

fs::path make_folder()
{
#if defined(_WIN32)
    // The folder of temporary files is the user's alone there.
    std::error_code failure;
    const auto path = fs::temp_directory_path(failure) / ("taut-" + std::to_string(std::random_device()()));
    if (failure || !fs::create_directory(path, failure)) throw error("no temporary folder can be made: set TMP");
    return path;
#else
    std::string name = (fs::temp_directory_path() / "taut-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw error("no temporary folder can be made: set TMPDIR");
    return name;
#endif
}

} // namespace

temporary_folder::temporary_folder()
{
    const std::scoped_lock lock(guard);
    path_ = make_folder();
    living.insert(path_);
}

temporary_folder::~temporary_folder()
{
    const std::scoped_lock lock(guard);
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    living.erase(path_);
}

void remove_temporary_folders() noexcept
{
    guard.lock(); // for good
    std::error_code ignored;
    for (const auto& path : living) fs::remove_all(path, ignored);
}

} // namespace taut::tools
