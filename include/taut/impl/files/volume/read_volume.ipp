// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <system_error>
#include <utility>

#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/volume/formats.hpp>
#include <taut/impl/files/volume/gmsh2.hpp>
#include <taut/impl/files/volume/gmsh4.hpp>
#include <taut/impl/files/volume/medit.hpp>
#include <taut/impl/files/volume/problem.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/su2.hpp>
#include <taut/impl/files/volume/tetgen.hpp>
#include <taut/impl/files/volume/vtk.hpp>
#include <taut/impl/files/volume/vtu.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

inline void read_gmsh(volume_file& file)
{
    volume_builder to(file);
    gmsh_sections sections(to);
    if (sections.version_4())
        gmsh4_reader(to, sections).read();
    else
        gmsh2_reader(to, sections).read();
    sections.finish_groups();
    to.finish();
}

/// Fills in what the bytes of a file say.
inline void read_volume_bytes(volume_file& file, volume_format format)
{
    file.format = name_of(format);
    if (file.zone < 0) throw parameter_error("zone", std::to_string(file.zone) + "; they count from 1, 0 is none");
    if (file.zone > 0 && format != volume_format::su2)
        throw io_error(file.path, "has no zones, which are of SU2 files; leave out --zone");
    if (file.bytes.empty() && format != volume_format::automatic)
        throw io_error(file.path, "the file is empty; save the mesh again");
    refuse_utf16(file.bytes, file.path);
    switch (format)
    {
    case volume_format::medit:
        return medit_reader(file).read();
    case volume_format::gmsh:
        return read_gmsh(file);
    case volume_format::vtk:
        return vtk_reader(file).read();
    case volume_format::vtu:
        return vtu_reader(file).read();
    case volume_format::tetgen:
        return tetgen_reader(file).read();
    case volume_format::su2:
        return su2_reader(file).read();
    case volume_format::problem:
        return problem_reader(file).read();
    case volume_format::automatic:
        break;
    }
    if (small_extension(file.path) == ".meshb")
        throw io_error(file.path, "binary MEDIT files are not read; convert it to .mesh");
    refuse_kind(file.path, "volumes are read from .mesh, .msh, .vtk, .vtu, .node with .ele, .su2 and .prob");
}

} // namespace taut::io::impl

namespace taut::io
{

volume_file read_volume_file(const std::filesystem::path& path, volume_format format, int zone)
{
    if (format == volume_format::automatic) format = impl::volume_format_of_name(path);
    volume_file file;
    file.path = path.string();
    file.zone = zone;
    if (format == volume_format::tetgen)
    {
        const auto beside = [&](const char* extension)
        { return std::filesystem::path(path).replace_extension(extension); };
        file.path = beside(".node").string();
        file.companions.push_back({".ele", impl::read_file(beside(".ele"))});
        std::error_code unknown;
        if (std::filesystem::exists(beside(".face"), unknown))
            file.companions.push_back({".face", impl::read_file(beside(".face"))});
    }
    if (format != volume_format::automatic) file.bytes = impl::read_file(file.path);
    impl::read_volume_bytes(file, format);
    return file;
}

mesh<tetrahedron> read_volume(const std::filesystem::path& path, volume_format format)
{
    return read_volume_file(path, format).tetrahedra();
}

} // namespace taut::io

namespace taut::io::impl
{

volume_file parse_volume(std::string bytes, volume_format format, const std::string& name, int zone)
{
    volume_file file;
    file.path = name;
    file.zone = zone;
    file.bytes = std::move(bytes);
    impl::read_volume_bytes(file, format);
    return file;
}

volume_file parse_tetgen(std::string nodes, std::string elements, std::string faces, const std::string& name)
{
    volume_file file;
    file.path = name;
    file.bytes = std::move(nodes);
    file.companions.push_back({".ele", std::move(elements)});
    if (!faces.empty()) file.companions.push_back({".face", std::move(faces)});
    impl::read_volume_bytes(file, volume_format::tetgen);
    return file;
}

} // namespace taut::io::impl
