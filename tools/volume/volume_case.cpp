// SPDX-License-Identifier: MIT
#include "volume/volume_case.hpp"

#include <array>
#include <iterator>

#include <taut/exact/cell_validity.hpp>
#include <taut/io/cell_faces.hpp>
#include <taut/io/read_volume.hpp>
#include <taut/io/write_volume.hpp>

#include "failure.hpp"
#include "outputs.hpp"
#include "text_table.hpp"

namespace taut::tools
{

bool names_volume(const std::string& path)
{
    constexpr std::array names = {".mesh", ".meshb", ".msh", ".vtk", ".vtu", ".node", ".ele", ".face", ".su2"};
    const auto name = extension(path);
    return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
}

void require_file(const std::string& output)
{
    if (output == "-" || output == standard_output)
        throw usage_error("-o -: a mesh goes to a file, in the format of the input; name one");
}

void require_name(const std::string& output, const io::volume_file& file)
{
    try
    {
        io::volume_outputs(output, file, file.points);
    }
    catch (const io::io_error& e)
    {
        throw usage_error(std::string("-o: ") + e.what());
    }
}

io::volume_file read_volume_at_rest(const std::string& path, const std::string& rest, int zone)
{
    auto file = io::read_volume_file(path, io::volume_format::automatic, zone);
    if (rest.empty()) return file;
    auto other = io::read_volume_file(rest, io::volume_format::automatic, zone);
    if (other.points.size() != file.points.size())
        throw unsuitable_input(rest + " has " + count(other.points.size(), "point", "points") + ", not " +
                               count(file.points.size()) + " as " + path);
    // Which cells are turned, the shape at rest says, where the two files have the same order of corners.
    std::vector<idx> differing;
    std::set_symmetric_difference(file.turned.begin(), file.turned.end(), other.turned.begin(), other.turned.end(),
                                  std::back_inserter(differing));
    const auto cells_of = [](const io::volume_file& f)
    {
        std::vector<std::pair<io::cell_kind, std::vector<idx>>> cells;
        io::for_each_cell(f, f.dimension,
                          [&](io::cell_kind kind, idx, std::span<const idx> corners)
                          { cells.emplace_back(kind, std::vector<idx>(corners.begin(), corners.end())); });
        return cells;
    };
    if (other.dimension == file.dimension && cells_of(other) != cells_of(file)) io::turn_cells(file, differing);
    if (other.dimension != file.dimension || cells_of(other) != cells_of(file))
        throw unsuitable_input(rest + " has other cells than " + path + "; give the same mesh at rest");
    file.rest = std::move(other.points);
    return file;
}

void require_mesh(const io::volume_file& file)
{
    if (auto found = io::check_sides(file); !found.empty()) throw mesh_error(std::move(found.front()));
}

void judge_insides(const io::volume_file& file, std::span<const vec3> x, volume_state& state)
{
    io::for_each_cell(file, 3,
                      [&](io::cell_kind, idx number, std::span<const idx> corners)
                      {
                          if (std::binary_search(state.inverted.begin(), state.inverted.end(), number)) return;
                          std::vector<vec3> places;
                          for (const idx v : corners) places.push_back(x[static_cast<std::size_t>(v)]);
                          const auto verdict = validity_of_cell(places);
                          if (verdict == cell_validity::invalid) state.negative_inside.push_back(number);
                          if (verdict == cell_validity::undecided) state.undecided.push_back(number);
                      });
}

std::string turned_note(const io::volume_file& file)
{
    return io::describe_turned(file) + "; read turned over, and written as the file has it";
}

std::string count_cells(const io::volume_file& file, int dimension)
{
    std::array<std::size_t, 8> counts{};
    for (const auto& block : file.cells) counts[static_cast<std::size_t>(block.kind)] += block.size();
    std::string text;
    for (std::size_t k = 0; k < counts.size(); ++k)
    {
        const auto shape = io::shape_of(static_cast<io::cell_kind>(k));
        if (shape.dimension == dimension && counts[k] > 0)
            text += (text.empty() ? "" : ", ") + count(counts[k], shape.name, shape.names);
    }
    return text;
}

} // namespace taut::tools
