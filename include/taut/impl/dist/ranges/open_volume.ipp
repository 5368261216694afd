// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/dist/ranges/open_volume.hpp>

#include <utility>

#include <taut/impl/dist/ranges/foam_volume.hpp>
#include <taut/impl/dist/ranges/gmsh_lines.hpp>
#include <taut/impl/dist/ranges/medit_lines.hpp>
#include <taut/impl/dist/ranges/pvtu_volume.hpp>
#include <taut/impl/dist/ranges/su2_lines.hpp>
#include <taut/impl/dist/ranges/tetgen_lines.hpp>
#include <taut/impl/dist/ranges/text_volume.hpp>
#include <taut/impl/dist/ranges/vtu_volume.hpp>
#include <taut/impl/files/volume/formats.hpp>

namespace taut::dist::impl
{

bool names_pieces(const communicator& all, const std::filesystem::path& path)
{
    return io::impl::small_extension(path) == ".pvtu" || all.shared(foam_volume::is_case(path));
}

std::unique_ptr<ranged_volume> open_volume(const communicator& all, const std::filesystem::path& path)
{
    if (names_pieces(all, path))
    {
        std::unique_ptr<ranged_volume> pieces;
        const bool vtk = io::impl::small_extension(path) == ".pvtu";
        if (vtk)
            pieces = std::make_unique<pvtu_volume>(all, path);
        else
            pieces = std::make_unique<foam_volume>(all, path);
        pieces->format = vtk ? "PVTU" : "OpenFOAM";
        return pieces;
    }
    const auto format = io::impl::volume_format_of_name(path);
    std::unique_ptr<ranged_volume> volume;
    const auto lines = [&](line_layout layout) { volume = std::make_unique<text_volume>(all, std::move(layout)); };
    switch (format)
    {
    case io::volume_format::su2:
        lines(su2_lines(all, path));
        break;
    case io::volume_format::medit:
        lines(medit_lines(all, path));
        break;
    case io::volume_format::gmsh:
        lines(gmsh_lines_reader(all, path).take());
        break;
    case io::volume_format::tetgen:
        lines(tetgen_lines(all, path));
        break;
    case io::volume_format::vtu:
        volume = std::make_unique<vtu_volume>(all, path);
        break;
    default:
        throw unsuited("its format is not read by ranges");
    }
    volume->format = io::impl::name_of(format);
    if (volume->cells == 0 || volume->vertices == 0) throw unsuited("it has no cells");
    return volume;
}

} // namespace taut::dist::impl
