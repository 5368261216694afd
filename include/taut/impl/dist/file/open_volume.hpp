// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <taut/impl/dist/file/gmsh_lines.hpp>
#include <taut/impl/dist/file/medit_lines.hpp>
#include <taut/impl/dist/file/su2_lines.hpp>
#include <taut/impl/dist/file/tetgen_lines.hpp>
#include <taut/impl/dist/file/text_volume.hpp>
#include <taut/impl/dist/file/vtu_volume.hpp>
#include <taut/impl/io/volume/formats.hpp>

namespace taut::dist::impl
{

/// Collective. Reads a volume by ranges. Throws unsuited where that cannot be, for whatever reason.
inline std::unique_ptr<ranged_volume> open_volume(const communicator& all, const std::filesystem::path& path)
{
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
