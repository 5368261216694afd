// SPDX-License-Identifier: MIT
#include "mpi/mpi_check.hpp"

#include <memory>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include <taut/dist.hpp>
#include <taut/impl/dist/ranges/deal.hpp>
#include <taut/impl/dist/ranges/open_volume.hpp>
#include <taut/impl/dist/ranges/piece_shapes.hpp>
#include <taut/volume_file.hpp>

#include "mpi/mpi_options.hpp"
#include "shared/command_line.hpp"
#include "shared/failure.hpp"
#include "shared/report_files.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools::mpi
{

namespace
{

/// What was found.
struct checked
{
    dist::certificate simplices;
    std::string cells; ///< by kind
    bool mixed = false;
    int dimension = 3;
    std::int64_t negative = 0, undecided = 0; ///< cells with positive corners that are not found valid inside
};

nlohmann::ordered_json to_json(const mpi_check_options& o, const checked& found)
{
    const auto& c = found.simplices;
    nlohmann::ordered_json json = {{"schema", "taut.mpi.check/1"}, {"input", o.input},
                                   {"elements", c.elements},       {"inverted", c.flipped},
                                   {"inverted_ids", c.ids},        {"branch_edges", c.branched},
                                   {"branch_ids", c.branch_ids},   {"valid", static_cast<bool>(c)}};
    if (found.mixed && found.dimension == 3)
        json["insides"] = {{"negative", found.negative}, {"undecided", found.undecided}};
    return json;
}

std::string text_of(const mpi_check_options& o, const checked& found)
{
    const auto& c = found.simplices;
    const auto list = [](const std::vector<std::int64_t>& ids)
    {
        std::string text;
        for (const auto id : ids) text += (text.empty() ? " (" : ", ") + std::to_string(id);
        return text.empty() ? text : text + ')';
    };
    labelled_lines lines;
    const bool plane = found.dimension == 2;
    lines.add("mesh", o.input + ": " + found.cells);
    lines.add(found.mixed ? "inverted corners" : "inverted",
              count(static_cast<std::uint64_t>(c.flipped)) + list(c.ids));
    lines.add("wound twice",
              count(static_cast<std::uint64_t>(c.branched), plane ? "vertex" : "edge", plane ? "vertices" : "edges") +
                  list(c.branch_ids));
    if (found.mixed && !plane)
        lines.add("insides", count(static_cast<std::uint64_t>(found.negative)) + " negative, " +
                                 count(static_cast<std::uint64_t>(found.undecided)) + " undecided");
    return (std::ostringstream() << lines).str();
}

/// What is checked: a volume, by ranges or in its pieces, or what process 0 reads. Cells that are turned in the file
/// are for that one.
struct subject
{
    std::unique_ptr<dist::impl::ranged_volume> volume; ///< null: process 0 read it
    io::volume_file file;                              ///< of process 0
    int dimension = 3;
};

subject read(const dist::impl::communicator& all, const mpi_check_options& o)
{
    subject s;
    try
    {
        const bool pieces = dist::impl::names_pieces(all, o.input);
        if (o.zone != 0 && pieces) throw usage_error("--zone is for SU2 files; leave it out");
        if (o.zone != 0) throw dist::impl::unsuited("a zone is asked for");
        s.volume = dist::impl::open_volume(all, o.input);
        if (s.volume->partitioned) return s;
        const auto corners = s.volume->at_corners(s.volume->piece.points);
        const auto shapes = dist::impl::piece_shapes(all, s.volume->piece, corners);
        if (!(shapes.worst.mean_ratio > 0)) throw dist::impl::unsuited("cells are inverted or flat");
    }
    catch (const dist::impl::unsuited&)
    {
        s.volume = nullptr;
        all.together(
            [&]
            {
                if (all.rank() == 0) s.file = io::read_volume_file(o.input, io::volume_format::automatic, o.zone);
            });
        s.dimension = all.shared(s.file.dimension);
    }
    return s;
}

template <class Element>
checked check_whole(const dist::impl::communicator& all, const io::volume_file& file)
{
    checked found;
    std::unique_ptr<io::impl::corner_simplices<Element>> parts;
    all.together(
        [&]
        {
            if (all.rank() != 0) return;
            parts = std::make_unique<io::impl::corner_simplices<Element>>(file.corner_simplices<Element>());
            found.cells = count_cells(file, Element::dimension);
            found.mixed = parts->overlapping;
            if (!parts->overlapping || Element::dimension != 3) return;
            volume_state state;
            judge_insides(file, file.points, state);
            found.negative = static_cast<std::int64_t>(state.negative_inside.size());
            found.undecided = static_cast<std::int64_t>(state.undecided.size());
        });
    const bool overlapping = all.shared(found.mixed);
    found.simplices = dist::check(all.raw(), dist::impl::dealt<Element>(all, parts ? &parts->simplices : nullptr,
                                                                        overlapping ? parts.get() : nullptr));
    found.dimension = Element::dimension;
    return found;
}

checked check_ranged(const dist::impl::communicator& all, const dist::impl::ranged_volume& volume)
{
    checked found;
    const auto doubts = volume.doubts(volume.piece.points);
    found.negative = all.sum(static_cast<std::int64_t>(doubts.negative.size()));
    found.undecided = all.sum(static_cast<std::int64_t>(doubts.undecided.size()));
    found.mixed = volume.mixed;
    found.cells = count_kinds(volume.kinds);
    found.simplices = dist::check(all.raw(), volume.piece);
    return found;
}

} // namespace

void declare_check(const subcommand& app, mpi_check_options& o)
{
    add_input(app, "MESH", o.input, "the input", meshes).required();
    add_zone(app, o.zone);
    app.add_flag("--json", o.json, "Print JSON");
    app.footer(
        "exit codes: 0 certified; 2 usage; 3 unreadable input; 4 an element is inverted or flat, or the input is\n"
        "  no mesh");
}

exit_code run_check(const dist::impl::communicator& all, const mpi_check_options& o)
{
    const auto input = read(all, o);
    const auto found = input.volume           ? check_ranged(all, *input.volume)
                       : input.dimension == 2 ? check_whole<triangle>(all, input.file)
                                              : check_whole<tetrahedron>(all, input.file);
    all.together(
        [&]
        {
            if (all.rank() == 0) write_standard_output(o.json ? tools::text_of(to_json(o, found)) : text_of(o, found));
        });
    return found.simplices ? exit_code::valid : exit_code::unsuitable_input;
}

} // namespace taut::tools::mpi
