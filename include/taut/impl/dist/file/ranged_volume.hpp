// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/dist/file/shared_file.hpp>
#include <taut/impl/dist/mesh_piece.hpp>
#include <taut/impl/mesh/mesh.hpp>

namespace taut::dist::impl
{

/// Name of a group of vertices in a file, and the dimension of its entities.
struct named_group
{
    std::string name;
    int dimension;
};

/// A file of tetrahedra of which each process has read a share: vertices in contiguous ranges by their places in the
/// file, which are their ids.
class ranged_volume
{
public:
    virtual ~ranged_volume() = default;

    mesh_piece<tetrahedron> piece;
    std::int64_t vertices = 0, cells = 0; ///< of all processes
    std::string format;                   ///< as volume_file::format
    std::vector<named_group> groups;      ///< the same on all processes

    /// Collective. Vertices of a group among those of the piece, ascending, each once.
    virtual std::vector<std::int64_t> members(std::size_t group) const = 0;

    /// An output that is complete but for its name, and that name.
    using outputs = std::vector<std::unique_ptr<shared_output>>;

    /// Collective. Writes the file with other coordinates, all else as it was. x: one per vertex of the piece. Throws
    /// io_error.
    virtual outputs write(const std::filesystem::path& path, const std::vector<vec3>& x) const = 0;

    /// Collective. Vertices by their places in the file, sent to whom has them; ascending, each once.
    std::vector<std::int64_t> at_home(std::vector<std::int64_t> places) const
    {
        sort_unique(places);
        auto mine = all_.exchange(by_home(places)).items;
        sort_unique(mine);
        return mine;
    }

    /// Collective. Sends records, which have the place of a vertex as `id`, to whom has it.
    template <class Record>
    std::vector<Record> sent_home(const std::vector<Record>& records) const
    {
        parcels<Record> to(all_.ranks());
        for (const auto& r : records) to[home(r.id)].push_back(r);
        return all_.exchange(to).items;
    }

    /// Collective. The values x, one per vertex of the piece, at the corners of the cells of the piece.
    std::vector<std::array<vec3, 4>> at_corners(const std::vector<vec3>& x) const
    {
        std::vector<std::int64_t> wanted;
        for (const auto& c : piece.cells) wanted.insert(wanted.end(), c.begin(), c.end());
        sort_unique(wanted);
        const auto asked = all_.exchange(by_home(wanted));
        parcels<vec3> tell(all_.ranks());
        for (std::size_t r = 0; r < all_.ranks(); ++r)
            for (const std::int64_t v : asked.from(r)) tell[r].push_back(x[static_cast<std::size_t>(v - first())]);
        const auto told = all_.exchange(tell).items; // homes ascend as vertices do
        std::vector<std::array<vec3, 4>> corners(piece.cells.size());
        for (std::size_t c = 0; c < corners.size(); ++c)
            for (std::size_t k = 0; k < 4; ++k)
                corners[c][k] = told[static_cast<std::size_t>(
                    std::lower_bound(wanted.begin(), wanted.end(), piece.cells[c][k]) - wanted.begin())];
        return corners;
    }

    /// The first vertex of this process.
    std::int64_t first() const { return bounds_[static_cast<std::size_t>(all_.rank())]; }

    const communicator& processes() const { return all_; }

protected:
    explicit ranged_volume(const communicator& all) : all_(all) {}

    /// Collective. Once the piece has its vertices: which process has which.
    void bound()
    {
        const auto n = static_cast<std::int64_t>(piece.ids.size());
        bounds_ = all_.gathered(std::vector<std::int64_t>{all_.before(n)});
        bounds_.push_back(all_.sum(n));
        vertices = bounds_.back();
        cells = all_.sum(static_cast<std::int64_t>(piece.cells.size()));
    }

    static void sort_unique(std::vector<std::int64_t>& x)
    {
        std::sort(x.begin(), x.end());
        x.erase(std::unique(x.begin(), x.end()), x.end());
    }
    std::size_t home(std::int64_t v) const
    {
        return static_cast<std::size_t>(std::upper_bound(bounds_.begin(), bounds_.end() - 1, v) - bounds_.begin()) - 1;
    }
    parcels<std::int64_t> by_home(const std::vector<std::int64_t>& places) const
    {
        parcels<std::int64_t> to(all_.ranks());
        for (const std::int64_t v : places) to[home(v)].push_back(v);
        return to;
    }

    communicator all_;
    std::vector<std::int64_t> bounds_; ///< process r has the vertices [bounds[r], bounds[r + 1])
};

} // namespace taut::dist::impl
