// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/types.hpp>
#include <taut/impl/io/atomic_file.hpp>
#include <taut/impl/io/file/scanner.hpp>
#include <taut/impl/io/read_file.hpp>

namespace taut::io
{

/// One line of a file of pins. An infinite weight makes it hard: the coordinates in `held` (bit k: coordinate k) hold
/// exactly. A finite one makes it a spring to `target`, of which all coordinates are given.
template <int D>
struct pin
{
    idx vertex = 0;
    std::uint8_t held = 0;
    vec<D> target{0.0};
    double weight = std::numeric_limits<double>::infinity();

    bool hard() const { return std::isinf(weight); }
};

} // namespace taut::io

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

/// "vertex,u,v[,weight]"
template <int D>
std::string pin_columns()
{
    return D == 2 ? "vertex,u,v[,weight]" : "vertex,x,y,z[,weight]";
}

/// A header stands for the columns of this format: their number, and the weight last.
template <int D>
void require_header(const pin_reader& in)
{
    const auto& cells = in.cells();
    const bool weight_last = cells.size() != D + 2 || cells.back() == "weight";
    if (cells.size() < D + 1 || cells.size() > D + 2 || cells[0] != "vertex" || !weight_last)
        in.fail("not the columns " + pin_columns<D>() + "; put them in this order");
}

template <int D>
pin<D> read_pin(const pin_reader& in)
{
    const auto& cells = in.cells();
    if (cells.size() < D + 1 || cells.size() > D + 2)
        in.fail(std::to_string(cells.size()) + (cells.size() == 1 ? " column" : " columns") + "; write " +
                pin_columns<D>() + ", and nothing between two commas or after the last where a coordinate is free");
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
    if (!(p.weight >= 0)) in.fail("a weight that is negative or not a number; give one >= 0, or inf for a hard pin");
    if (p.held == 0) in.fail("no coordinate is given; give one at least, or remove the line");
    if (!p.hard() && p.held != (1u << D) - 1)
        in.fail("a spring (finite weight) needs all coordinates; give them, or leave the weight out");
    return p;
}

/// Reads pins as CSV: `vertex,u,v[,weight]`, for volumes `vertex,x,y,z[,weight]`; vertices count from 0. No weight, or
/// inf: a hard pin, whose empty coordinates are free. A finite weight: a spring. A header line, empty lines and
/// comments from # are ignored. A coordinate of a vertex may be given once.
/// vertices: their number in the mesh. Throws io_error with the line.
template <int D>
std::vector<pin<D>> parse_pins(std::string_view text, const std::string& path = "pins",
                               idx vertices = std::numeric_limits<idx>::max())
{
    impl::pin_reader in(text, path);
    std::vector<pin<D>> pins;
    std::map<idx, std::pair<std::uint8_t, std::size_t>> given; // bits, and the last line
    for (bool first = true; in.next(); first = false)
    {
        const std::string_view cell = in.cells()[0];
        const bool letter = !cell.empty() && ((cell[0] >= 'a' && cell[0] <= 'z') || (cell[0] >= 'A' && cell[0] <= 'Z'));
        if (first && letter)
        {
            impl::require_header<D>(in);
            continue;
        }
        pins.push_back(impl::read_pin<D>(in));
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

namespace taut::io
{

/// Reads a file of pins and springs. vertices: their number in the mesh. Throws io_error with the line: unreadable,
/// malformed, or a vertex out of range.
template <int D>
std::vector<pin<D>> read_pins(const std::filesystem::path& path, idx vertices = std::numeric_limits<idx>::max())
{
    return impl::parse_pins<D>(impl::read_file(path), path.string(), vertices);
}

/// Writes pins as read_pins reads them, with the digits that give every number back bit for bit. Throws io_error.
template <int D>
void write_pins(const std::filesystem::path& path, std::span<const pin<D>> pins)
{
    std::string text = D == 2 ? "vertex,u,v,weight\n" : "vertex,x,y,z,weight\n";
    const auto append = [&text](double x)
    {
        std::array<char, 32> digits{};
        text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
    };
    for (const pin<D>& p : pins)
    {
        text += std::to_string(p.vertex);
        for (int k = 0; k < D; ++k)
        {
            text += ',';
            if ((p.held >> k & 1u) != 0) append(p.target[k]);
        }
        text += ',';
        append(p.weight);
        text += '\n';
    }
    write_file(path, text);
}

} // namespace taut::io
