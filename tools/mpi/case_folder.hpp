// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace taut::tools::mpi
{

/// Whether two names are of one folder, which need not be there.
bool same_folder(const std::filesystem::path& a, const std::filesystem::path& b);

/// Whether a folder has nothing in it but meshes of OpenFOAM: constant/polyMesh, or those of processor0, processor1,
/// ...
bool holds_meshes_alone(const std::filesystem::path& folder);

/// Removes a folder with all in it, if it is there. Throws io_error.
void remove_folder(const std::filesystem::path& folder);

/// Gives a complete folder its name; what had the name is removed. On Linux a folder of that name is there all the
/// time, where the file system can exchange two. Throws io_error.
void replace_folder(const std::filesystem::path& made, const std::filesystem::path& name);

} // namespace taut::tools::mpi
