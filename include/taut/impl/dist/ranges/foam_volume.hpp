// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

#include <taut/impl/dist/ranges/foam_mesh.hpp>
#include <taut/impl/dist/ranges/pieces_volume.hpp>

namespace taut::dist::impl
{

/// A case of OpenFOAM, which is a folder: the mesh of processor0, processor1, ..., or the one that is not decomposed.
/// Vertices have the numbers of the mesh before that (pointProcAddressing). Written as a folder with the same meshes.
class foam_volume : public pieces_volume
{
public:
    static bool is_case(const std::filesystem::path& path)
    {
        std::error_code unknown;
        return std::filesystem::is_directory(path, unknown);
    }

    /// Collective. Throws io_error, mesh_error.
    foam_volume(const communicator& all, const std::filesystem::path& path) : pieces_volume(all)
    {
        std::int64_t pieces = 0;
        all_.together(
            [&]
            {
                if (all_.rank() == 0) pieces = count_pieces(path);
            });
        pieces = all_.shared(pieces);
        decomposed_ = pieces > 0;
        all_.together(
            [&]
            {
                const auto [begin, end] = share(static_cast<std::size_t>(std::max<std::int64_t>(1, pieces)));
                for (std::size_t k = begin; k < end; ++k) files_.push_back(read_piece(path, k));
            });
        join();
    }

protected:
    std::filesystem::path output_of(const mesh_file& part, const std::filesystem::path& path) const override
    {
        return folder_of(path, part.number) / "points";
    }

    void add_index(const std::filesystem::path&, named_later&) const override {}

private:
    std::filesystem::path folder_of(const std::filesystem::path& path, std::size_t k) const
    {
        const auto folder = decomposed_ ? path / ("processor" + std::to_string(k)) : path;
        return folder / "constant" / "polyMesh";
    }

    /// 0: the mesh is not decomposed.
    static std::int64_t count_pieces(const std::filesystem::path& path)
    {
        std::error_code unknown;
        std::int64_t pieces = 0, most = -1;
        for (const auto& entry : std::filesystem::directory_iterator(path, unknown))
        {
            const std::string name = entry.path().filename().string();
            if (!name.starts_with("processor") || !entry.is_directory(unknown)) continue;
            const std::string number = name.substr(9);
            if (number.starts_with('s'))
                throw io::io_error(entry.path().string(), "pieces in one file (collated) are not read; decompose the "
                                                          "mesh with -fileHandler uncollated");
            if (number.empty() || number.size() > 9 || number.find_first_not_of("0123456789") != number.npos) continue;
            ++pieces;
            most = std::max<std::int64_t>(most, std::stoll(number));
        }
        if (pieces != most + 1)
            throw io::io_error(path.string(), "folders processor0 to processor" + std::to_string(most) +
                                                  " are not all there; decompose the mesh again");
        if (pieces == 0 && !std::filesystem::is_directory(path / "constant" / "polyMesh", unknown))
            throw io::io_error(path.string(), "no case of OpenFOAM: it has neither processor0/constant/polyMesh nor "
                                              "constant/polyMesh; name a file, or a case with a mesh");
        return pieces;
    }

    mesh_file read_piece(const std::filesystem::path& path, std::size_t k) const
    {
        const auto folder = folder_of(path, k);
        require_own(path, folder);
        mesh_file read{.number = k, .file = foam_mesh(folder).take()};
        const std::size_t n = read.file.points.size();
        if (decomposed_)
            read.global_ids = foam_mesh::original_points(folder, n);
        else
            for (std::size_t v = 0; v < n; ++v) read.global_ids.push_back(static_cast<std::int64_t>(v));
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
            if (entry.is_regular_file() && entry.path() != folder / "points") read.others.push_back(entry.path());
        std::sort(read.others.begin(), read.others.end());
        return read;
    }

    /// Cases are untrusted, and all files of a mesh are copied: throws io_error for a link out of the case, and for
    /// what is no file, as a pipe, which would be waited for.
    static void require_own(const std::filesystem::path& path, const std::filesystem::path& folder)
    {
        const auto require = [&](const std::filesystem::path& one)
        {
            if (!io::impl::path_within(path, one))
                throw io::io_error(one.string(), "is a link out of the case " + path.string() +
                                                     ", or to nothing; put what it leads to in its place");
        };
        std::error_code unknown;
        if (!std::filesystem::exists(std::filesystem::symlink_status(folder, unknown))) return;
        require(folder);
        std::filesystem::recursive_directory_iterator at(folder, unknown), end;
        for (; !unknown && at != end; at.increment(unknown))
        {
            if (at->is_symlink(unknown)) require(at->path());
            if (std::filesystem::is_other(at->status(unknown)))
                throw io::io_error(at->path().string(), "is no file; move it out of the mesh");
        }
        if (unknown) throw io::io_error(folder.string(), "cannot be read: " + unknown.message());
    }

    bool decomposed_ = false;
};

} // namespace taut::dist::impl
