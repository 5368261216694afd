// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/pieces_volume.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/xml.hpp>
#include <taut/volume_file.hpp>

namespace taut::dist::impl
{

/// The files that a .pvtu names; none where it cannot be read.
inline std::vector<std::filesystem::path> pieces_of(const std::filesystem::path& path)
{
    std::vector<std::filesystem::path> files;
    try
    {
        const std::string bytes = io::impl::read_file(path);
        io::impl::xml_tags tags(bytes);
        while (const auto tag = tags.next())
            if (const auto source = tag->attribute("Source"); source && tag->name == "Piece")
                files.push_back(path.parent_path() / io::impl::from_xml(*source));
    }
    catch (const io::io_error&)
    {
        return {};
    }
    return files;
}

/// An unstructured grid of VTK in pieces: a .pvtu that names .vtu files, of any encoding. Written as a .pvtu whose
/// pieces lie in a folder beside it that has its name.
class pvtu_volume : public pieces_volume
{
public:
    /// Collective. Throws io_error, mesh_error.
    pvtu_volume(const communicator& all, const std::filesystem::path& path) : pieces_volume(all)
    {
        all_.together(
            [&]
            {
                read_index(path);
                const auto [begin, end] = share(sources_.size());
                for (std::size_t k = begin; k < end; ++k) files_.push_back(read_piece(path, k));
            });
        join();
    }

    std::vector<std::filesystem::path> files_at(const std::filesystem::path& path) const override
    {
        auto files = pieces_volume::files_at(path);
        if (all_.rank() == 0) files.push_back(path);
        return files;
    }

    /// What is there already in the folder of an output belongs to the output that is there, or to somebody else.
    void require_output(const std::filesystem::path& path) const override
    {
        pieces_volume::require_output(path);
        std::error_code unknown;
        const auto before = pieces_of(path);
        const auto is_own = [&](const auto& target)
        {
            return std::any_of(before.begin(), before.end(),
                               [&](const auto& one) { return std::filesystem::equivalent(one, target, unknown); });
        };
        for (const auto& part : files_)
            if (const auto target = output_of(part, path); std::filesystem::exists(target, unknown) && !is_own(target))
                throw io::io_error(target.string(), "is there already and no piece of " + path.string() +
                                                        "; move it away, or give the output another name");
    }

protected:
    std::filesystem::path output_of(const mesh_file& part, const std::filesystem::path& path) const override
    {
        return path.parent_path() / path.stem() / names_[part.number];
    }

    void add_index(const std::filesystem::path& path, named_later& to) const override
    {
        if (path.extension() != ".pvtu")
            throw io::io_error(path.string(), "the output has the format of its input; give it the extension .pvtu");
        std::string text;
        std::size_t done = 0;
        for (std::size_t k = 0; k < sources_.size(); ++k)
        {
            text.append(bytes_, done, sources_[k].first - done);
            text += io::impl::to_xml(path.stem().string() + '/' + names_[k]);
            done = sources_[k].first + sources_[k].second;
        }
        to.add(path, text.append(bytes_, done));
    }

private:
    void read_index(const std::filesystem::path& path)
    {
        bytes_ = io::impl::read_file(path);
        io::impl::xml_tags tags(bytes_);
        bool known = false;
        while (const auto tag = tags.next())
        {
            if (tag->name == "VTKFile") known = tag->attribute_or("type", "") == "PUnstructuredGrid";
            if (tag->name != "Piece") continue;
            const auto source = tag->attribute("Source");
            if (!source || source->empty())
                throw io::io_error(path.string(), "a piece has no Source; save the mesh again");
            sources_.push_back({static_cast<std::size_t>(source->data() - bytes_.data()), source->size()});
        }
        if (!known) throw io::io_error(path.string(), "no VTKFile of type PUnstructuredGrid; save the mesh as one");
        if (sources_.empty()) throw io::io_error(path.string(), "it has no pieces; save the mesh again");
        std::set<std::filesystem::path> named;
        std::set<std::string> taken;
        for (std::size_t k = 0; k < sources_.size(); ++k)
        {
            const auto place = std::filesystem::path(source(k)).lexically_normal();
            if (place.is_absolute() || *place.begin() == "..")
                throw io::io_error(path.string(), "names the piece " + source(k) +
                                                      ", outside of its folder; put the pieces beside it or below");
            if (!named.insert(place).second)
                throw io::io_error(path.string(), "names the piece " + source(k) + " twice; name each once");
            auto name = place.filename().string();
            while (!taken.insert(name).second) name = std::to_string(k) + '-' + name; // of another folder
            names_.push_back(std::move(name));
        }
    }

    std::string source(std::size_t k) const
    {
        return io::impl::from_xml(std::string_view(bytes_).substr(sources_[k].first, sources_[k].second));
    }

    mesh_file read_piece(const std::filesystem::path& path, std::size_t k) const
    {
        const auto place = path.parent_path() / source(k);
        std::error_code unknown;
        if (std::filesystem::exists(place, unknown) && !io::impl::path_within(path.parent_path(), place))
            throw io::io_error(path.string(), "names the piece " + source(k) +
                                                  ", a link out of its folder; put the piece itself there");
        if (std::filesystem::is_other(std::filesystem::status(place, unknown)))
            throw io::io_error(place.string(), "is no file; put the piece itself there");
        mesh_file read{.number = k, .file = {}};
        read.file.path = place.string();
        read.file.bytes = io::impl::read_file(place);
        std::string ids;
        io::impl::xml_tags tags(read.file.bytes);
        while (const auto tag = tags.next())
        {
            if (tag->name == "Piece" && tag->attribute_or("NumberOfPoints", "") == "0") return read; // stays as it is
            if (tag->name == "PointData") ids = tag->attribute_or("GlobalIds", "");
            if (tag->name == "AppendedData" || tag->name == "Points") break;
        }
        read.file = io::impl::parse_volume(std::move(read.file.bytes), io::volume_format::vtu, place.string());
        for (auto& label : read.file.labels)
        {
            static constexpr std::array<std::string_view, 4> global = {"vtkGlobalPointIds", "GlobalPointIds",
                                                                       "GlobalNodeId", "GlobalNodeIds"};
            const bool known = std::find(global.begin(), global.end(), label.name) != global.end();
            if (!label.of_cells && (known || (!ids.empty() && label.name == ids)) && read.global_ids.empty())
                read.global_ids.assign(label.values.begin(), label.values.end());
            if (!label.of_cells || (label.name != "vtkGhostType" && label.name != "vtkGhostLevels")) continue;
            for (const long long x : label.values) // 1: of another piece
                read.ghosts.push_back(label.name == "vtkGhostType" ? (x & 1) != 0 : x > 0);
        }
        return read;
    }

    std::string bytes_;
    std::vector<std::pair<std::size_t, std::size_t>> sources_; ///< first byte and number of bytes
    std::vector<std::string> names_;                           ///< of the pieces of an output
};

} // namespace taut::dist::impl
