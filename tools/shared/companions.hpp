// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace taut::tools
{

/// Returns whether a name is that of one of TetGen's files of a mesh.
bool is_tetgen(const std::filesystem::path& file);

/// The files that are read with a mesh, as parts of it: TetGen's .node, .ele and, if there is one, .face, and what the
/// buffers of glTF name beside the document. The mesh need not be there.
/// images: those of glTF, too
std::vector<std::filesystem::path> companions_of(const std::filesystem::path& mesh, bool images = false);

/// The files that are written where a mesh of that name is asked for. source: the mesh that it is made of, or nothing.
std::vector<std::filesystem::path> written_as(const std::filesystem::path& output, const std::filesystem::path& source);

} // namespace taut::tools
