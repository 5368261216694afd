// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/deal.hpp>
#include <taut/impl/dist/ranges/ranged_volume.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

namespace taut::dist::impl
{

/// A volume that process 0 reads and writes.
class whole_volume : public ranged_volume
{
public:
    /// Collective. Throws io_error, mesh_error.
    whole_volume(const communicator& all, const std::filesystem::path& path) : ranged_volume(all)
    {
        std::unique_ptr<io::impl::corner_simplices<tetrahedron>> parts;
        std::vector<std::string> names;
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                file_ = io::read_volume_file(path);
                parts =
                    std::make_unique<io::impl::corner_simplices<tetrahedron>>(file_.corner_simplices<tetrahedron>());
                mixed = parts->overlapping;
                cells = parts->cells.back() + 1;
                format = file_.format;
                for (const auto& g : file_.groups) names.push_back(std::to_string(g.dimension) + g.name);
            });
        mixed = all_.shared(mixed);
        cells = all_.shared(cells);
        piece = dealt<tetrahedron>(all_, parts ? &parts->simplices : nullptr, mixed ? parts.get() : nullptr);
        format = all_.shared(format);
        for (const auto& name : all_.gathered(names)) groups.push_back({name.substr(1), name[0] - '0'});
        bound();
    }

    std::vector<std::int64_t> members(std::size_t group) const override
    {
        std::vector<std::int64_t> places;
        if (all_.rank() == 0) places.assign(file_.groups[group].vertices.begin(), file_.groups[group].vertices.end());
        return at_home(std::move(places));
    }

    /// The file has its name at once.
    outputs write(const std::filesystem::path& path, const std::vector<vec3>& x) const override
    {
        const auto all = collected(all_, x);
        all_.together(
            [&]
            {
                if (all_.rank() == 0) file_.write(path, all);
            });
        return {};
    }

private:
    io::volume_file file_; ///< of process 0
};

} // namespace taut::dist::impl
