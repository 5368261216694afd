// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace taut::tools
{

/// The files that are read with a mesh, as parts of it: TetGen's .node, .ele and, if there is one, .face, and what the
/// buffers of glTF name beside the document. The mesh need not be there.
/// images: those of glTF, too
std::vector<std::filesystem::path> companions_of(const std::filesystem::path& mesh, bool images = false);

/// The files that are written where a mesh of that name is asked for. source: the mesh that it is made of, or nothing.
std::vector<std::filesystem::path> written_as(const std::filesystem::path& output, const std::filesystem::path& source);

/// The file that lies where an output would take it for a part of itself, although it is not written with it; or
/// nothing.
std::filesystem::path stray_companion(const std::filesystem::path& output, const std::filesystem::path& source);

} // namespace taut::tools
