// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/dist/ranges/cell_labels.hpp>
#include <taut/impl/dist/ranges/shared_file.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/mesh_piece.hpp>
#include <taut/volume_file.hpp>

namespace taut::dist::impl
{

/// Name of a group of vertices in a file, and the dimension of its entities.
struct named_group
{
    std::string name;
    int dimension;
};

/// Cells that are not known to be valid, ascending.
struct cell_doubts
{
    std::vector<idx> negative, undecided;
};

/// A volume of which each process has read a share: vertices in contiguous ranges by their places in the file, which
/// are their ids, and cells as the simplices at their corners.
class ranged_volume
{
public:
    virtual ~ranged_volume() = default;

    mesh_piece<tetrahedron> piece;
    std::int64_t vertices = 0, cells = 0; ///< of all processes
    std::string format;                   ///< as volume_file::format
    bool partitioned = false;             ///< in files of its own pieces, which process 0 cannot read as a whole
    bool mixed = false;                   ///< there are cells other than tetrahedra
    bool single = false;                  ///< what is written is rounded to single precision
    std::array<std::int64_t, 8> kinds{};  ///< cells of all processes by cell_kind
    std::vector<named_group> groups;      ///< the same on all processes

    /// Collective. Vertices of a group among those of the piece, ascending, each once.
    virtual std::vector<std::int64_t> members(std::size_t group) const = 0;

    /// Collective. Labels of the cells here, one per cell (not per simplex of the piece), and of faces.
    virtual labelled_cells labelled() const { return {}; }

    /// Outputs that are complete but for their names; each process names those that it has.
    using outputs = std::vector<std::unique_ptr<pending_output>>;

    /// Collective. Writes the file with other coordinates, all else as it was. x: one per vertex of the piece. Throws
    /// io_error.
    virtual outputs write(const std::filesystem::path& path, const std::vector<vec3>& x) const = 0;

    /// Of this process: the files that write() makes.
    virtual std::vector<std::filesystem::path> files_at(const std::filesystem::path& path) const { return {path}; }

    /// Of this process, before anything is solved. Throws io_error where an output would replace an input.
    virtual void require_output(const std::filesystem::path&) const {}

    /// Collective. Gives outputs their names, those of process 0 last. Throws io_error.
    void commit(const outputs& files) const
    {
        for (const bool first : {false, true})
            all_.together(
                [&]
                {
                    if ((all_.rank() == 0) == first)
                        for (const auto& file : files) file->commit();
                });
    }

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

    /// Collective. The values x, one per vertex of the piece, at vertices, ascending, each once.
    std::vector<vec3> values_at(const std::vector<std::int64_t>& wanted, const std::vector<vec3>& x) const
    {
        const auto asked = all_.exchange(by_home(wanted));
        parcels<vec3> tell(all_.ranks());
        for (std::size_t r = 0; r < all_.ranks(); ++r)
            for (const std::int64_t v : asked.from(r)) tell[r].push_back(x[static_cast<std::size_t>(v - first())]);
        return all_.exchange(tell).items; // homes ascend as vertices do
    }

    /// Collective. The values x, one per vertex of the piece, at the corners of the simplices of the piece.
    std::vector<std::array<vec3, 4>> at_corners(const std::vector<vec3>& x) const
    {
        std::vector<std::int64_t> wanted;
        for (const auto& c : piece.cells) wanted.insert(wanted.end(), c.begin(), c.end());
        sort_unique(wanted);
        const auto told = values_at(wanted, x);
        std::vector<std::array<vec3, 4>> corners(piece.cells.size());
        for (std::size_t c = 0; c < corners.size(); ++c)
            for (std::size_t k = 0; k < 4; ++k) corners[c][k] = told[place_in(wanted, piece.cells[c][k])];
        return corners;
    }

    /// Collective. Cells of this process, by their numbers here, whose insides Bezier bounds do not find valid.
    cell_doubts doubts(const std::vector<vec3>& x) const
    {
        cell_doubts found;
        if (!mixed) return found;
        auto wanted = corners_;
        sort_unique(wanted);
        const auto told = values_at(wanted, x);
        std::vector<vec3> places;
        each_solid(
            [&](idx number, io::cell_kind, std::span<const std::int64_t> corners)
            {
                places.clear();
                for (const std::int64_t v : corners) places.push_back(told[place_in(wanted, v)]);
                const auto verdict = validity_of_cell(places);
                if (verdict == cell_validity::invalid) found.negative.push_back(number);
                if (verdict == cell_validity::undecided) found.undecided.push_back(number);
            });
        return found;
    }

    /// The simplices at the corners of the cells of this process; of cells in `edged`, ascending, at their edges, too.
    void make_parts(std::span<const idx> edged = {})
    {
        auto names = corners_;
        sort_unique(names);
        io::volume_file local;
        local.points.resize(names.size());
        each_solid(
            [&](idx, io::cell_kind kind, std::span<const std::int64_t> corners)
            {
                if (local.cells.empty() || local.cells.back().kind != kind) local.cells.push_back({kind, {}});
                for (const std::int64_t v : corners)
                    local.cells.back().corners.push_back(static_cast<idx>(place_in(names, v)));
            });
        piece.cells.clear();
        if (local.cells.empty()) return;
        auto parts = local.corner_simplices<tetrahedron>(edged);
        for (const auto& c : parts.simplices.cells())
        {
            auto& ids = piece.cells.emplace_back();
            for (std::size_t k = 0; k < 4; ++k) ids[k] = names[static_cast<std::size_t>(c[k])];
        }
        piece.owners.assign(parts.cells.begin(), parts.cells.end());
        piece.weights = std::move(parts.weights);
        piece.edges = std::move(parts.regular);
    }

    /// The first vertex of this process.
    std::int64_t first() const { return bounds_[static_cast<std::size_t>(all_.rank())]; }

    const communicator& processes() const { return all_; }

protected:
    explicit ranged_volume(const communicator& all) : all_(all) {}

    /// Takes a cell of three dimensions, whose corners are in VTK's order.
    void add_solid(io::cell_kind kind, std::span<const std::int64_t> corners)
    {
        solids_.push_back(static_cast<char>(kind));
        corners_.insert(corners_.end(), corners.begin(), corners.end());
    }

    /// Collective. Once corners of cells are places of vertices.
    void finish_cells()
    {
        kinds = {};
        for (const char kind : solids_) ++kinds[static_cast<unsigned char>(kind)];
        all_.add(std::span<std::int64_t>(kinds));
        cells = std::accumulate(kinds.begin(), kinds.end(), std::int64_t{0});
        mixed = cells != kinds[static_cast<std::size_t>(io::cell_kind::tetrahedron)];
        if (mixed) return all_.together([this] { make_parts(); });
        for (std::size_t k = 0; k + 3 < corners_.size(); k += 4)
            piece.cells.push_back({corners_[k], corners_[k + 1], corners_[k + 2], corners_[k + 3]});
        corners_ = {};
        solids_ = {};
    }

    /// f(number, kind, corners) of the cells of this process.
    template <class F>
    void each_solid(const F& f) const
    {
        std::size_t at = 0;
        for (std::size_t c = 0; c < solids_.size(); ++c)
        {
            const auto kind = static_cast<io::cell_kind>(solids_[c]);
            const auto n = static_cast<std::size_t>(io::impl::shape_of(kind).corners);
            f(static_cast<idx>(c), kind, std::span<const std::int64_t>(corners_).subspan(at, n));
            at += n;
        }
    }

    static std::size_t place_in(const std::vector<std::int64_t>& sorted, std::int64_t v)
    {
        return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), v) - sorted.begin());
    }

    /// Collective. Once the piece has its vertices: which process has which.
    void bound()
    {
        const auto n = static_cast<std::int64_t>(piece.ids.size());
        bounds_ = all_.gathered(std::vector<std::int64_t>{all_.before(n)});
        bounds_.push_back(all_.sum(n));
        vertices = bounds_.back();
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
    std::vector<char> solids_;          ///< kinds of the cells here; none where all are tetrahedra, once they are read
    std::vector<std::int64_t> corners_; ///< of these, one cell after the other
    std::vector<std::int64_t> bounds_;  ///< process r has the vertices [bounds[r], bounds[r + 1])
};

} // namespace taut::dist::impl
