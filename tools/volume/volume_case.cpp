// SPDX-License-Identifier: MIT
#include "volume/volume_case.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include <taut/certify.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

#include "shared/failure.hpp"
#include "shared/outputs.hpp"
#include "shared/text_table.hpp"

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

void require_name(const std::string& output, const io::volume_file& file, const std::string& option)
{
    try
    {
        io::impl::volume_outputs(output, file, file.points);
    }
    catch (const io::io_error& e)
    {
        throw usage_error(option + ": " + e.what());
    }
}

namespace
{

using cell = std::pair<io::cell_kind, std::vector<idx>>;

std::vector<cell> cells_of(const io::volume_file& file)
{
    std::vector<cell> cells;
    io::impl::for_each_cell(file, file.dimension,
                            [&](io::cell_kind kind, idx, std::span<const idx> corners)
                            { cells.emplace_back(kind, std::vector<idx>(corners.begin(), corners.end())); });
    return cells;
}

/// Returns whether two cells are the same one but for the order of corners, and one is turned over; none: they are
/// others.
std::optional<bool> turned_over(const cell& a, cell b)
{
    if (a == b) return false;
    if (a.first != b.first) return std::nullopt;
    auto& corners = b.second;
    if (a.first == io::cell_kind::triangle || a.first == io::cell_kind::tetrahedron)
    {
        bool odd = false; // of the exchanges that make one of the other
        for (std::size_t k = 0; k < corners.size(); ++k)
        {
            const auto at = std::find(corners.begin() + static_cast<std::ptrdiff_t>(k), corners.end(), a.second[k]);
            if (at == corners.end()) return std::nullopt;
            if (*at == corners[k]) continue;
            std::swap(*at, corners[k]);
            odd = !odd;
        }
        return odd;
    }
    const std::size_t around = a.first == io::cell_kind::wedge ? 3 : 4;
    for (const bool turned : {false, true})
    {
        for (std::size_t r = 0; r < around; ++r)
        {
            if (a == b) return turned;
            for (auto from = corners.begin(); corners.end() - from >= static_cast<std::ptrdiff_t>(around);
                 from += static_cast<std::ptrdiff_t>(around))
                std::rotate(from, from + 1, from + static_cast<std::ptrdiff_t>(around));
        }
        io::impl::turn_cell(b.first, corners);
    }
    return std::nullopt;
}

} // namespace

io::volume_file read_volume_at_rest(const std::string& path, const std::string& rest, int zone)
{
    auto file = io::read_volume_file(path, io::volume_format::automatic, zone);
    if (rest.empty()) return file;
    auto other = io::read_volume_file(rest, io::volume_format::automatic, zone);
    if (other.points.size() != file.points.size())
        throw unsuitable_input(rest + " has " + count(other.points.size(), "point", "points") + ", not " +
                               count(file.points.size()) + " as " + path + "; give the same mesh at rest");
    const auto cells = cells_of(file), at_rest = cells_of(other);
    // Which order of corners is right, the shape at rest says.
    std::vector<idx> differing;
    bool same = other.dimension == file.dimension && cells.size() == at_rest.size();
    for (std::size_t c = 0; same && c < cells.size(); ++c)
    {
        const auto turned = turned_over(cells[c], at_rest[c]);
        same = turned.has_value();
        if (turned.value_or(false)) differing.push_back(static_cast<idx>(c));
    }
    if (!same) throw unsuitable_input(rest + " has other cells than " + path + "; give the same mesh at rest");
    io::impl::turn_cells(file, differing);
    file.rest = std::move(other.points);
    return file;
}

void require_mesh(const io::volume_file& file)
{
    if (auto found = io::impl::check_sides(file); !found.empty()) throw mesh_error(std::move(found.front()));
}

void judge_insides(const io::volume_file& file, std::span<const vec3> x, volume_state& state)
{
    io::impl::for_each_cell(file, 3,
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
    return io::impl::describe_turned(file) + "; read with reversed orientation, and written in the order of the file";
}

std::string count_cells(const io::volume_file& file, int dimension)
{
    std::array<std::size_t, 8> counts{};
    for (const auto& block : file.cells) counts[static_cast<std::size_t>(block.kind)] += block.size();
    std::string text;
    for (std::size_t k = 0; k < counts.size(); ++k)
    {
        const auto shape = io::impl::shape_of(static_cast<io::cell_kind>(k));
        if (shape.dimension == dimension && counts[k] > 0)
            text += (text.empty() ? "" : ", ") + count(counts[k], shape.name, shape.names);
    }
    return text;
}

} // namespace taut::tools
