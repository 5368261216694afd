// SPDX-License-Identifier: MIT
#include "shared/temporary_folder.hpp"

#include <cstdlib>
#include <random>
#include <string>
#include <system_error>

#include <taut/errors.hpp>

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

} // namespace

temporary_folder::temporary_folder()
{
#if defined(_WIN32)
    // The folder of temporary files is the user's alone there.
    std::error_code failure;
    path_ = fs::temp_directory_path(failure) / ("taut-" + std::to_string(std::random_device()()));
    if (failure || !fs::create_directory(path_, failure)) throw error("no temporary folder can be made: set TMP");
#else
    std::string name = (fs::temp_directory_path() / "taut-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw error("no temporary folder can be made: set TMPDIR");
    path_ = name;
#endif
}

temporary_folder::~temporary_folder()
{
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

} // namespace taut::tools
