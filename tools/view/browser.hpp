// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <sys/types.h>

#include "shared/temporary_folder.hpp"

namespace taut::view
{

/// The user's browser, which opens an address. What every user of the machine can see, the arguments of a program,
/// names a file that this user alone can read, and that leads there. The file goes with the object.
class browser
{
public:
    /// Opens a browser, if there is one. Throws error, std::system_error where the file cannot be written.
    explicit browser(const std::string& url);

    /// To be called now and then: takes note of the end of the program that has opened it.
    void look() noexcept;

private:
    tools::temporary_folder folder_;
    pid_t process_ = 0; ///< 0: none, or no longer
};

} // namespace taut::view
