// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/file/scanner.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
{

/// Reads the four blocks of a problem, each a line with its size and then one item per line.
class prob_reader
{
public:
    prob_reader(std::string_view text, const std::string& path) : in_(text, path) { in_.require_text(); }

    /// The rest block, which stands before the dimension is known.
    void read_rest()
    {
        const std::size_t n = read_size("the number of rest vertices");
        const std::size_t d = read_dimension("the dimension of the rest shape");
        end_line("the size of the rest block");
        rest_.reserve(fitting(n));
        for (std::size_t v = 0; v < n; ++v)
        {
            start_item("rest vertex", v, n);
            vec3 p(0.0);
            for (std::size_t k = 0; k < d; ++k) p[static_cast<int>(k)] = read_coordinate();
            end_line("a rest vertex of " + std::to_string(d) + " coordinates");
            rest_.push_back(p);
        }
        initial_count_ = read_size("the number of vertices of the initial map");
        if (initial_count_ != n)
            in_.fail("the initial map has " + std::to_string(initial_count_) + " vertices and the rest shape has " +
                     std::to_string(n) + "; give one position a vertex");
        map_dimension_ = read_dimension("the dimension of the map");
        end_line("the size of the initial map");
    }

    std::size_t map_dimension() const { return map_dimension_; }

    /// Byte offsets of the coordinates of the initial map.
    std::vector<std::size_t> take_places() { return std::move(places_); }

    template <class Element>
    prob_file<Element> read_map()
    {
        constexpr int D = Element::dimension;
        if (map_dimension_ != D)
            in_.fail("a map to " + std::to_string(map_dimension_) + " dimensions, expected " + std::to_string(D) +
                     "; read it as the other kind of mesh");
        prob_file<Element> p;
        p.rest = std::move(rest_);
        p.initial.reserve(initial_count_);
        for (std::size_t v = 0; v < initial_count_; ++v)
        {
            start_item("vertex of the initial map", v, initial_count_);
            vec<D> x;
            for (int k = 0; k < D; ++k)
            {
                in_.skip_blanks();
                places_.push_back(static_cast<std::size_t>(in_.position() - in_.start()));
                x[k] = read_coordinate();
            }
            end_line("a mapped vertex of " + std::to_string(D) + " coordinates");
            p.initial.push_back(x);
        }
        read_cells(p);
        read_fixed(p);
        in_.skip_space();
        if (!in_.done()) in_.fail_at_word("the end of the file");
        return p;
    }

private:
    template <class Element>
    void read_cells(prob_file<Element>& p)
    {
        const std::size_t n = read_size(std::string("the number of ") + Element::names);
        const auto corners = in_.integer("the number of corners");
        if (corners != Element::corners)
            in_.fail(std::to_string(corners) + " corners a cell; " + Element::names + " have " +
                     std::to_string(Element::corners));
        end_line("the size of the block of cells");
        if (n == 0) in_.fail(std::string("no ") + Element::names + "; give at least one");
        p.cells.reserve(fitting(n));
        for (std::size_t c = 0; c < n; ++c)
        {
            start_item(Element::name, c, n);
            auto& cell = p.cells.emplace_back();
            for (std::size_t k = 0; k < cell.size(); ++k)
            {
                cell[k] = read_vertex();
                if (std::find(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(k), cell[k]) !=
                    cell.begin() + static_cast<std::ptrdiff_t>(k))
                    in_.fail(std::string(Element::name) + ' ' + std::to_string(c) + " names vertex " +
                             std::to_string(cell[k]) + " twice; remove it");
            }
            end_line(std::string("a ") + Element::name);
        }
    }

    template <class Element>
    void read_fixed(prob_file<Element>& p)
    {
        const std::size_t n = read_size("the number of fixed vertices");
        end_line("the number of fixed vertices");
        p.fixed.reserve(fitting(n));
        for (std::size_t k = 0; k < n; ++k)
        {
            start_item("fixed vertex", k, n);
            p.fixed.push_back(read_vertex());
            end_line("a fixed vertex");
        }
    }

    std::size_t read_size(const std::string& what)
    {
        in_.skip_space();
        const long long n = in_.integer(what.c_str());
        if (n < 0 || n > std::numeric_limits<idx>::max())
            in_.fail(what + " is " + std::to_string(n) + "; it must fit 32 bits");
        return static_cast<std::size_t>(n);
    }

    std::size_t read_dimension(const std::string& what)
    {
        const long long d = in_.integer(what.c_str());
        if (d != 2 && d != 3) in_.fail(what + " is " + std::to_string(d) + "; it must be 2 or 3");
        return static_cast<std::size_t>(d);
    }

    double read_coordinate()
    {
        const double x = in_.number();
        if (!std::isfinite(x)) in_.fail("a coordinate is not finite; give finite numbers");
        return x;
    }

    idx read_vertex()
    {
        const long long v = in_.integer("the number of a vertex");
        if (v < 0 || v >= static_cast<long long>(initial_count_))
            in_.fail("vertex " + std::to_string(v) + " of " + std::to_string(initial_count_) +
                     "; vertices count from 0");
        return static_cast<idx>(v);
    }

    /// Goes to the next item of a block, past empty lines.
    void start_item(const char* what, std::size_t i, std::size_t n)
    {
        in_.skip_space();
        if (in_.done())
            in_.fail("the file ends before " + std::string(what) + ' ' + std::to_string(i) + " of " +
                     std::to_string(n) + "; correct the number, or add what is missing");
    }

    void end_line(const std::string& what)
    {
        if (!in_.line_ends()) in_.fail_at_word("the end of the line after " + what);
    }

    /// Number of items to reserve, which a wrong count must not exaggerate: an item takes two bytes at least.
    std::size_t fitting(std::size_t n) const { return std::min(n, in_.remaining() / 2); }

    scanner in_;
    std::vector<vec3> rest_;
    std::size_t initial_count_ = 0, map_dimension_ = 0;
    std::vector<std::size_t> places_;
};

/// Reads an untangling problem in the plain text format of Du et al. ("Lifting simplices to find injectivity", 2020):
///
///     nRest dimRest           then nRest lines of rest coordinates
///     nInit dimMap            then nInit = nRest lines: the initial map
///     nSimplices dimMap+1     then one simplex per line, vertices counted from 0, positive at rest
///     nFixed                  then one fixed vertex per line
///
/// Throws io_error with the line of a fault.
template <class Element>
prob_file<Element> parse_prob(std::string_view text, const std::string& path = "problem text")
{
    impl::prob_reader reader(text, path);
    reader.read_rest();
    return reader.read_map<Element>();
}

} // namespace taut::io::impl
