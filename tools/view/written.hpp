// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "shared/temporary_folder.hpp"

namespace taut::view
{

/// The bytes of what write(path) writes.
template <class Write>
std::string written(const Write& write)
{
    const tools::temporary_folder folder;
    const auto path = folder.path() / "out.obj";
    write(path);
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace taut::view
