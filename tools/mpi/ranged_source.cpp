// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <utility>

#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/dist/ranges/open_volume.hpp>
#include <taut/impl/dist/ranges/piece_shapes.hpp>
#include <taut/impl/files/file/atomic_file_bodies.hpp>
#include <taut/impl/files/volume/formats.hpp>

#include "mpi/case_folder.hpp"
#include "mpi/ranged_targets.hpp"
#include "mpi/shape_source.hpp"
#include "shared/failure.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"
#include "volume/group_targets.hpp"

namespace taut::tools::mpi
{

namespace
{

using dist::impl::ranged_volume;

/// What names of outputs are held against.
io::volume_file head_of(const ranged_volume& volume, const std::string& path)
{
    io::volume_file file;
    file.path = path;
    file.format = volume.format;
    if (volume.format == io::impl::name_of(io::volume_format::tetgen))
    {
        file.path = std::filesystem::path(path).replace_extension(".node").string();
        file.companions = {{".ele", {}}, {".face", {}}};
    }
    return file;
}

/// A checkpoint of a case of OpenFOAM is a folder of its own, or will be one.
void require_case(const mpi_options& o)
{
    const std::string& path = o.checkpoint;
    const auto refuse = [&](const std::string& why) { throw usage_error("--checkpoint " + path + ": " + why); };
    for (const auto* other : {&o.shape.input, &o.shape.output})
    {
        if (same_folder(path, *other)) refuse("is also the input or the output; name another folder");
        if (lies_in(*other, path) || lies_in(path, *other))
            refuse("and " + *other + " are in each other; name another folder");
    }
    std::error_code unknown;
    if (!std::filesystem::is_directory(path, unknown)) return; // of a file more is said when it is read
    if (const auto found = listed_folder(path).stranger(); !found.empty())
        refuse("is there already, and " + found + " is of no checkpoint; name another folder");
}

void require_place(const ranged_volume& volume, const mpi_options& o)
{
    const auto& shape = o.shape;
    check(shape);
    require_half_turns(shape.moves);
    if (!volume.partitioned)
    {
        require_names(o, head_of(volume, shape.input));
        if (io::impl::is_stream(shape.output)) throw usage_error("-o: name a file");
        return;
    }
    if (volume.format == "OpenFOAM")
    {
        if (!o.checkpoint.empty()) require_case(o);
        return;
    }
    for (const auto* name : {&shape.output, &o.checkpoint})
        if (!name->empty() && io::impl::small_extension(*name) != ".pvtu")
            throw usage_error(*name + ": what is written has the format of the input; give it the extension .pvtu");
}

class ranged : public shape_source<tetrahedron>
{
public:
    ranged(std::unique_ptr<ranged_volume> volume, const shape_options& shape, mpi_report& report)
        : volume_(std::move(volume)), shape_(shape), all_(volume_->processes())
    {
        mixed = volume_->mixed;
        auto held = targets_of(*volume_, shape_);
        pins = std::move(held.pins);
        fixed = std::move(held.fixed);
        notes = std::move(held.notes);
        if (volume_->single) round_pins();
        if (shape_.smoothing && !shape_.free_interfaces) kept = volume_->labelled();
        report.pins = static_cast<std::size_t>(held.pinned);
        report.springs = static_cast<std::size_t>(held.springs);
        piece = std::move(volume_->piece);
        volume_->piece.points = piece.points; // what is written is held against them
        volume_->piece.ids = piece.ids;
    }

    std::vector<idx> doubtful(const points& x) const override { return both(volume_->doubts(in_file(x))); }

    dist::mesh_piece<tetrahedron> edged(const std::vector<idx>& cells) const override
    {
        all_.together([&] { volume_->make_parts(cells); });
        auto result = volume_->piece;
        volume_->piece.cells.clear();
        return result;
    }

    points read(const std::string& path) const override
    {
        const auto refuse = [&]
        {
            throw unsuitable_input(path + ": a checkpoint of another mesh, by its number of vertices; remove it, or "
                                          "name another file");
        };
        struct placed
        {
            std::int64_t id;
            vec3 x;
        };
        std::vector<placed> mine;
        std::int64_t vertices = 0;
        try
        {
            const auto found = dist::impl::open_volume(all_, path);
            vertices = found->vertices;
            for (std::size_t v = 0; v < found->piece.ids.size(); ++v)
                mine.push_back({found->piece.ids[v], found->piece.points[v]});
        }
        catch (const dist::impl::unsuited& e)
        {
            throw io::io_error(path, std::string("cannot be read as a checkpoint: ") + e.what());
        }
        if (vertices != volume_->vertices) refuse();
        points x(piece.ids.size());
        for (const auto& p : volume_->sent_home(mine)) x[static_cast<std::size_t>(p.id - volume_->first())] = p.x;
        return x;
    }

    void write(const std::string& path, const points& x) const override
    {
        ranged_volume::outputs files;
        writing([&] { files = volume_->write(path, in_file(x)); });
        writing([&] { volume_->commit(files); });
    }

    std::vector<std::string> files_at(const std::string& path) const override
    {
        std::vector<std::string> files;
        for (const auto& file : volume_->files_at(path)) files.push_back(file.string());
        return all_.gathered(files);
    }

    void finish(const points& given, mpi_report& report, const report_writer& write_report) override
    {
        const auto x = in_file(given);
        volume_->piece.cells = piece.cells;
        const auto corners = volume_->at_corners(x);
        volume_->piece.cells.clear();
        if (volume_->single) require_rounded(corners);
        report.after.shapes = dist::impl::piece_shapes(all_, piece, corners);
        const auto doubts = volume_->doubts(x);
        report.after.negative_inside = numbered(doubts.negative);
        report.after.undecided = numbered(doubts.undecided);
        ranged_volume::outputs files;
        writing([&] { files = volume_->write(shape_.output, x); });
        all_.together(
            [&]
            {
                if (all_.rank() == 0) write_report({});
            });
        writing([&] { volume_->commit(files); });
    }

private:
    static std::vector<idx> both(dist::impl::cell_doubts doubts)
    {
        auto all = std::move(doubts.negative);
        all.insert(all.end(), doubts.undecided.begin(), doubts.undecided.end());
        std::sort(all.begin(), all.end());
        return all;
    }

    /// Numbers of cells among those of all processes.
    std::vector<idx> numbered(std::vector<idx> here) const
    {
        std::int64_t cells = 0;
        for (std::size_t c = 0; c < piece.cells.size(); ++c)
            cells += c == 0 || piece.owners.empty() || piece.owners[c] != piece.owners[c - 1];
        const auto before = static_cast<idx>(all_.before(cells));
        for (idx& c : here) c += before;
        return all_.gathered(here);
    }

    points in_file(const points& x) const
    {
        if (!volume_->single) return x;
        auto rounded = x;
        for (vec3& p : rounded)
            for (int k = 0; k < 3; ++k) p[k] = impl::in_single(p[k]);
        return rounded;
    }

    /// Pins stay where the file can hold them.
    void round_pins()
    {
        dist::constraints<tetrahedron> held;
        std::int64_t rounded = 0;
        bool beyond = false;
        for (const auto& e : pins.entries())
        {
            if (e.weight != 0)
            {
                held.spring(e.id, e.x, e.weight);
                continue;
            }
            for (int k = 0; k < 3; ++k)
                if ((e.held >> k & 1U) != 0)
                {
                    const double there = impl::in_single(e.x[k]);
                    beyond = beyond || (std::isfinite(e.x[k]) && !std::isfinite(there));
                    held.pin(e.id, k, there);
                    rounded += there != e.x[k];
                }
        }
        all_.together(
            [&]
            {
                if (beyond)
                    throw unsuitable_input("a pin is beyond the single precision of the file; save the input in "
                                           "double precision");
            });
        pins = std::move(held);
        if (all_.sum(rounded) > 0)
            notes.push_back("pins are rounded to the single precision of the file, and fixed there");
    }

    void require_rounded(const std::vector<std::array<vec3, 4>>& corners) const
    {
        std::int64_t flipped = 0;
        for (const auto& c : corners) flipped += impl::orient(c[0], c[1], c[2], c[3]).sign <= 0;
        flipped = all_.sum(flipped);
        all_.together(
            [&]
            {
                if (flipped > 0)
                    throw no_valid_map("in the single precision of the file " +
                                       count(static_cast<std::uint64_t>(flipped), "corner is", "corners are") +
                                       " inverted; save the input in double precision, or move it to the origin");
            });
    }

    std::unique_ptr<ranged_volume> volume_;
    const shape_options& shape_;
    const dist::impl::communicator& all_;
};

} // namespace

std::unique_ptr<shape_source<tetrahedron>> ranged_source(const dist::impl::communicator& all, const mpi_options& o,
                                                         mpi_report& report)
{
    const auto& shape = o.shape;
    try
    {
        const bool pieces = dist::impl::names_pieces(all, shape.input);
        const bool asked = !shape.rest.empty() || shape.zone != 0;
        if (asked && pieces) throw usage_error("--rest and --zone are not of meshes in pieces; leave them out");
        if (asked) throw dist::impl::unsuited("--rest or --zone is given");
        auto volume = dist::impl::open_volume(all, shape.input);
        report.before.shapes = dist::impl::piece_shapes(all, volume->piece, volume->at_corners(volume->piece.points));
        if (!volume->partitioned && !(report.before.shapes.worst.mean_ratio > 0))
            throw dist::impl::unsuited("cells are inverted or flat");
        all.together(
            [&]
            {
                if (all.rank() == 0) require_place(*volume, o);
                writing([&] { volume->require_output(shape.output); });
            });
        report.format = volume->format;
        report.cells = count_kinds(volume->kinds);
        report.mixed = volume->mixed;
        report.vertices = static_cast<std::size_t>(volume->vertices);
        report.elements = static_cast<std::size_t>(volume->cells);
        return std::make_unique<ranged>(std::move(volume), shape, report);
    }
    catch (const dist::impl::unsuited& e)
    {
        report.before = volume_state();
        report.read_whole = e.what();
        return nullptr;
    }
}

} // namespace taut::tools::mpi
