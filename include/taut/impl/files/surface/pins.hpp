// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/core/short_number.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/files/file/scanner.hpp>
#include <taut/surface_file.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

inline std::string_view trim(std::string_view s)
{
    const auto first = s.find_first_not_of(" \t\v\f");
    return first == s.npos ? std::string_view() : s.substr(first, s.find_last_not_of(" \t\v\f") - first + 1);
}

/// Reads lines of comma-separated cells; # starts a comment. Lines end with LF, CR LF or CR.
class pin_reader
{
public:
    pin_reader(std::string_view text, const std::string& path) : rest_(text), path_(path)
    {
        if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3); // byte order mark of UTF-8
        refuse_utf16(rest_, path_);
        if (rest_.substr(0, 4096).find('\0') != rest_.npos)
            throw io_error(path_, "not a text file: it has bytes 0; save it as text");
    }

    /// The cells of the next line that has any; false at the end.
    bool next()
    {
        while (!rest_.empty())
        {
            const auto end = rest_.find_first_of("\r\n");
            std::string_view line = rest_.substr(0, end);
            const bool both = end != rest_.npos && rest_.substr(end).starts_with("\r\n");
            rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + (both ? 2 : 1));
            ++line_;
            line = trim(line.substr(0, line.find('#')));
            if (line.empty()) continue;
            cells_.clear();
            for (;;)
            {
                const auto comma = line.find(',');
                cells_.push_back(trim(line.substr(0, comma)));
                if (comma == line.npos) return true;
                line.remove_prefix(comma + 1);
            }
        }
        return false;
    }

    const std::vector<std::string_view>& cells() const { return cells_; }
    std::size_t line() const { return line_; }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw io_error(path_, what, file_place{file_place::line, line_});
    }

    template <class Number>
    Number number(std::string_view cell, const char* what) const
    {
        const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
        Number x{};
        const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
        if (failure != std::errc{} || end != digits.data() + digits.size())
            fail("expected " + std::string(what) + ", found '" + std::string(cell.substr(0, 40)) + "'");
        return x;
    }

private:
    std::string_view rest_;
    std::string path_;
    std::vector<std::string_view> cells_;
    std::size_t line_ = 0;
};

/// Columns of a file of pins: a vertex, its coordinates, a weight.
struct pin_columns
{
    int dimension = 3;
    std::optional<double> plane; ///< the z of a planar mesh, which may stand behind x and y
    bool z = false;              ///< it does, in the lines of four columns

    bool fits(std::size_t count) const
    {
        const auto least = static_cast<std::size_t>(dimension) + 1;
        return count >= least && count <= least + (plane ? 2 : 1);
    }

    /// Returns whether a line of so many columns has a z that is no coordinate of the map.
    bool has_z(std::size_t count) const { return plane && (count == 5 || (count == 4 && z)); }

    std::string text() const
    {
        if (dimension == 3) return "vertex,x,y,z[,weight]";
        return plane ? "vertex,x,y[,z][,weight]" : "vertex,u,v[,weight]";
    }
};

/// The columns that a header stands for: their number, and the weight last.
inline pin_columns columns_of_header(const pin_reader& in, pin_columns columns)
{
    const auto& cells = in.cells();
    const std::size_t n = cells.size();
    columns.z = columns.plane && n >= 4 && cells[3] == "z";
    const auto least = static_cast<std::size_t>(columns.dimension) + (columns.z ? 2 : 1);
    if (!columns.fits(n) || cells[0] != "vertex" || n > least + 1 || (n == least + 1 && cells.back() != "weight"))
        in.fail("not the columns " + columns.text() + "; put them in this order");
    return columns;
}

/// Throws io_error for a z elsewhere than in the plane of the mesh; digits that single precision has not are free.
inline void require_plane(const pin_reader& in, std::string_view cell, double plane)
{
    if (cell.empty()) return;
    const auto z = in.number<double>(cell, "z, or nothing");
    if (z == plane || taut::impl::in_single(z) == taut::impl::in_single(plane)) return;
    in.fail("z is " + std::string(cell) + ", and the mesh lies in the plane z = " + taut::impl::short_number(plane) +
            "; leave z out, or give that; a weight is behind z, or in a column that a first line names: "
            "vertex,x,y,weight");
}

template <int D>
pin<D> read_pin(const pin_reader& in, const pin_columns& columns)
{
    auto cells = in.cells();
    if (!columns.fits(cells.size()))
        in.fail(std::to_string(cells.size()) + (cells.size() == 1 ? " column" : " columns") + "; write " +
                columns.text() + ", and nothing between two commas or after the last where a coordinate is free");
    if (columns.has_z(cells.size()))
    {
        require_plane(in, cells[3], *columns.plane);
        cells.erase(cells.begin() + 3);
    }
    pin<D> p;
    p.vertex = in.number<idx>(cells[0], "the number of a vertex");
    if (p.vertex < 0) in.fail("vertex " + std::to_string(p.vertex) + "; vertices count from 0");
    for (int k = 0; k < D; ++k)
    {
        const std::string_view cell = cells[static_cast<std::size_t>(k) + 1];
        if (cell.empty()) continue;
        p.target[k] = in.number<double>(cell, "a coordinate, or nothing where it is free");
        if (!std::isfinite(p.target[k])) in.fail("a coordinate is not finite; leave it empty where it is free");
        p.held = static_cast<std::uint8_t>(p.held | 1u << k);
    }
    if (cells.size() == D + 2 && !cells.back().empty())
        p.weight = in.number<double>(cells.back(), "a weight, or nothing for a hard pin");
    if (!(p.weight >= 0)) in.fail("a weight that is negative or not a number; give one > 0, or inf for a hard pin");
    if (p.weight == 0) in.fail("a weight of 0, which does nothing; give one > 0, or leave the line out");
    if (p.held == 0) in.fail("no coordinate is given; give one at least, or remove the line");
    if (!p.hard() && p.held != (1u << D) - 1)
        in.fail("a spring (finite weight) needs all coordinates; give them, or leave the weight out");
    return p;
}

/// Reads pins as CSV: `vertex,u,v[,weight]`, for volumes `vertex,x,y,z[,weight]`; vertices count from 0. No weight, or
/// inf: a hard pin, whose empty coordinates are free. A finite weight: a spring. A header line, empty lines and
/// comments from # are ignored. A coordinate of a vertex may be given once.
/// vertices: their number in the mesh. plane: as read_pins() has it. Throws io_error with the line.
template <int D>
std::vector<pin<D>> parse_pins(std::string_view text, const std::string& path = "pins",
                               idx vertices = std::numeric_limits<idx>::max(), std::optional<double> plane = {})
{
    impl::pin_reader in(text, path);
    pin_columns columns{.dimension = D, .plane = D == 2 ? plane : std::nullopt, .z = true};
    std::vector<pin<D>> pins;
    std::map<idx, std::pair<std::uint8_t, std::size_t>> given; // bits, and the last line
    for (bool first = true; in.next(); first = false)
    {
        const std::string_view cell = in.cells()[0];
        const bool letter = !cell.empty() && ((cell[0] >= 'a' && cell[0] <= 'z') || (cell[0] >= 'A' && cell[0] <= 'Z'));
        if (first && letter)
        {
            columns = impl::columns_of_header(in, columns);
            continue;
        }
        pins.push_back(impl::read_pin<D>(in, columns));
        const pin<D>& p = pins.back();
        if (p.vertex >= vertices)
            in.fail("vertex " + std::to_string(p.vertex) + " of " + std::to_string(vertices) +
                    "; vertices count from 0");
        auto& [bits, line] = given[p.vertex];
        if ((bits & p.held) != 0)
            in.fail("vertex " + std::to_string(p.vertex) + " stands already in line " + std::to_string(line) +
                    "; leave one of the two out");
        bits = static_cast<std::uint8_t>(bits | p.held);
        line = in.line();
    }
    return pins;
}

} // namespace taut::io::impl
