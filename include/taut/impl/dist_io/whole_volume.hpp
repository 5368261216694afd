// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/dist_io/deal.hpp>
#include <taut/impl/dist_io/ranged_volume.hpp>
#include <taut/impl/io/read_volume.hpp>
#include <taut/impl/io/write_volume.hpp>

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
        std::string names;
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
                for (const auto& g : file_.groups) names += std::to_string(g.dimension) + g.name + '\n';
            });
        mixed = all_.shared(mixed);
        cells = all_.shared(cells);
        piece = dealt<tetrahedron>(all_, parts ? &parts->simplices : nullptr, mixed ? parts.get() : nullptr);
        format = all_.shared(format);
        names = all_.shared(names);
        for (std::size_t at = 0; at < names.size();)
        {
            const auto end = names.find('\n', at);
            groups.push_back({names.substr(at + 1, end - at - 1), names[at] - '0'});
            at = end + 1;
        }
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
