// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include <taut/impl/dist/ranges/ranged_volume.hpp>

namespace taut::dist::impl
{

/// Whether a name is that of a mesh in pieces, which the processes share: a .pvtu, or a folder.
bool names_pieces(const communicator& all, const std::filesystem::path& path);

/// Collective. Reads a volume by ranges, or in its pieces. Throws unsuited where it has no pieces and ranges cannot be,
/// for whatever reason; io_error, mesh_error for pieces.
std::unique_ptr<ranged_volume> open_volume(const communicator& all, const std::filesystem::path& path);

} // namespace taut::dist::impl
