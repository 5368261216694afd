// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <taut/files.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/scene.hpp>
#include <taut/impl/files/gltf/source.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// The same from memory; path: named in errors, and where external buffers are looked for.
gltf_model parse_gltf(std::string_view bytes, const std::string& path = "glTF file", int texcoord_set = 0);

/// The same of a file that is read, or was changed since.
gltf_model model_of(gltf_source source, int texcoord_set = 0);

/// The files that hold the buffers of the document at a path; none of a .glb, or where they cannot be told.
std::set<std::filesystem::path> gltf_companions(const std::filesystem::path& path);

/// The file for the buffer that is written beside a .gltf: OUT.bin beside OUT.gltf; none where it is in the document,
/// as in .glb. source: of the model that is written
/// Throws io_error if a file of that name is there that is no buffer of the document which OUT.gltf replaces;
/// parameter_error for another ending.
std::optional<std::filesystem::path> gltf_data_file(const std::filesystem::path& path, const gltf_source& source);

/// Encodes a model with new texture coordinates as the files to be written: one, or a .gltf and the .bin beside it.
/// Their bytes are made here.
///
/// The set is added or replaced in all primitives with triangles. A vertex is split only where its corners differ in
/// texture coordinates; vertices keep their numbers, new ones follow, with all attributes bit for bit. All else is
/// kept: every member of the JSON, the bytes of every bufferView that needs no change, and images, whose URIs are made
/// relative to the new file. All buffers become one.
///
/// corner_uv: one per corner of model.triangles, v downwards; a triangle with a corner that is not finite has no place:
///               it lies in one point, (0, 0)
/// texcoord_set: the N of TEXCOORD_N
/// path:         ends in .glb or .gltf
/// Throws io_error, also as gltf_data_file() does; parameter_error for a wrong number of corner_uv, a set without those
/// before it, another ending.
std::vector<file_to_write> gltf_files(const std::filesystem::path& path, const gltf_model& model,
                                      std::span<const std::array<vec2, 3>> corner_uv, int texcoord_set = 0,
                                      gltf_model::numbers numbers = gltf_model::numbers::floats);

} // namespace taut::io::impl
