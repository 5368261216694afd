// SPDX-License-Identifier: MIT
#include "mpi/mpi_check.hpp"

#include <memory>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include <taut/impl/dist/check.hpp>
#include <taut/impl/dist/deal.hpp>
#include <taut/impl/dist/file/open_volume.hpp>
#include <taut/impl/dist/file/piece_shapes.hpp>
#include <taut/impl/io/read_volume.hpp>

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

nlohmann::ordered_json to_json(const mpi_check_options& o, const dist::certificate& c)
{
    return {{"schema", "taut.mpi.check/1"}, {"input", o.input},
            {"elements", c.elements},       {"inverted", c.flipped},
            {"inverted_ids", c.ids},        {"branch_edges", c.branched},
            {"branch_ids", c.branch_ids},   {"valid", static_cast<bool>(c)}};
}

std::string text_of(const mpi_check_options& o, const dist::certificate& c)
{
    const auto list = [](const std::vector<std::int64_t>& ids)
    {
        std::string text;
        for (const auto id : ids) text += (text.empty() ? " (" : ", ") + std::to_string(id);
        return text.empty() ? text : text + ')';
    };
    labelled_lines lines;
    lines.add("mesh", o.input + ": " + count(static_cast<std::uint64_t>(c.elements), "tetrahedron", "tetrahedra"));
    lines.add("inverted", count(static_cast<std::uint64_t>(c.flipped)) + list(c.ids));
    lines.add("wound twice", count(static_cast<std::uint64_t>(c.branched), "edge", "edges") + list(c.branch_ids));
    return (std::ostringstream() << lines).str();
}

/// The mesh by ranges, or as process 0 reads it. Cells that are turned in the file are for that one.
dist::mesh_piece<tetrahedron> piece_of(const dist::impl::communicator& all, const mpi_check_options& o)
{
    try
    {
        if (o.zone != 0) throw dist::impl::unsuited("a zone is asked for");
        auto volume = dist::impl::open_volume(all, o.input);
        const auto shapes = dist::impl::piece_shapes(all, volume->at_corners(volume->piece.points));
        if (!(shapes.worst.mean_ratio > 0)) throw dist::impl::unsuited("cells are inverted or flat");
        return std::move(volume->piece);
    }
    catch (const dist::impl::unsuited&)
    {
        std::unique_ptr<mesh<tetrahedron>> m;
        all.together(
            [&]
            {
                if (all.rank() != 0) return;
                const auto file = io::read_volume_file(o.input, io::volume_format::automatic, o.zone);
                m = std::make_unique<mesh<tetrahedron>>(io::tetrahedra_of(file));
            });
        return dist::impl::dealt<tetrahedron>(all, m.get());
    }
}

} // namespace

void declare_check(CLI::App& app, mpi_check_options& o)
{
    add_input(app, "MESH", o.input, "the input", "Tetrahedra: .mesh .msh .vtk .vtu .node .su2")->required();
    add_zone(app, o.zone);
    app.add_flag("--json", o.json, "Print JSON");
    app.footer(
        "exit codes: 0 certified; 2 usage; 3 unreadable input; 4 an element is inverted or flat, or the input is\n"
        "  no mesh of tetrahedra");
}

exit_code run_check(const dist::impl::communicator& all, const mpi_check_options& o)
{
    const auto found = dist::check(all.raw(), piece_of(all, o));
    all.together(
        [&]
        {
            if (all.rank() == 0) write_standard_output(o.json ? tools::text_of(to_json(o, found)) : text_of(o, found));
        });
    return found ? exit_code::valid : exit_code::unsuitable_input;
}

} // namespace taut::tools::mpi
