// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/surface/surface_formats.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// The extension in small letters.
inline std::string small_extension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return extension;
}

/// By the extension; automatic if that is none of ours.
inline volume_format volume_format_of_name(const std::filesystem::path& path)
{
    const std::string e = small_extension(path);
    return e == ".mesh"                                  ? volume_format::medit
           : e == ".msh"                                 ? volume_format::gmsh
           : e == ".vtk"                                 ? volume_format::vtk
           : e == ".vtu"                                 ? volume_format::vtu
           : e == ".node" || e == ".ele" || e == ".face" ? volume_format::tetgen
           : e == ".su2"                                 ? volume_format::su2
           : e == ".prob"                                ? volume_format::problem
                                                         : volume_format::automatic;
}

/// TetGen's files of a mesh: .node, .ele and, if there are faces, .face.
inline std::vector<std::filesystem::path> tetgen_files(const std::filesystem::path& mesh, bool faces)
{
    std::vector<std::filesystem::path> files;
    for (const char* extension : {".node", ".ele", ".face"})
        files.push_back(std::filesystem::path(mesh).replace_extension(extension));
    if (!faces) files.pop_back();
    return files;
}

/// Those that are read with a mesh of that name, which need not be there; none where the name is not TetGen's.
inline std::vector<std::filesystem::path> tetgen_files(const std::filesystem::path& mesh)
{
    std::error_code unknown;
    if (volume_format_of_name(mesh) != volume_format::tetgen) return {};
    return tetgen_files(mesh, std::filesystem::is_regular_file(tetgen_files(mesh, true).back(), unknown));
}

/// As volume_file::format has it.
constexpr std::string_view name_of(volume_format format)
{
    switch (format)
    {
    case volume_format::automatic:
        break;
    case volume_format::medit:
        return "MEDIT";
    case volume_format::gmsh:
        return "gmsh";
    case volume_format::vtk:
        return "VTK";
    case volume_format::vtu:
        return "VTU";
    case volume_format::tetgen:
        return "TetGen";
    case volume_format::su2:
        return "SU2";
    case volume_format::problem:
        return "problem";
    }
    return {};
}

/// Throws io_error for a name that is of none of the kinds that a reader takes: the file is not there, is a folder, is
/// of another kind, or of one that nothing reads. wanted: "surfaces are read from .obj, ..."
[[noreturn]] inline void refuse_kind(const std::filesystem::path& path, const std::string& wanted)
{
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown) && !unknown)
        throw io_error(path.string(), std::generic_category().message(ENOENT));
    if (std::filesystem::is_directory(path, unknown)) throw io_error(path.string(), a_folder);
    const char* const kind =
        format_of_name(path) != surface_format::automatic                     ? "a surface in space"
        : volume_format_of_name(path) != volume_format::automatic             ? "a volume, or a mesh of the plane"
        : small_extension(path) == ".gltf" || small_extension(path) == ".glb" ? "a model of glTF"
                                                                              : "an unknown kind of file";
    throw io_error(path.string(), std::string(kind) + "; " + wanted + ", from other names if the format is given");
}

} // namespace taut::io::impl
