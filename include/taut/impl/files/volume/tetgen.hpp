// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/files/volume/builder.hpp>

namespace taut::io::impl
{

/// Reads TetGen's .node and .ele, and .face if there is one (TetGen manual, "File formats"); of two dimensions the
/// same files of Triangle. Comments from #.
class tetgen_reader
{
public:
    explicit tetgen_reader(volume_file& file) : to_(file), nodes_(to_.in(), encoding) {}

    void read()
    {
        read_nodes();
        for (const auto& companion : to_.file().companions)
        {
            scanner in(companion.bytes, name_of(companion));
            in.require_text();
            number_source from(in, encoding);
            if (companion.extension == ".ele") read_elements(from);
            if (companion.extension == ".face") read_faces(from);
        }
        to_.file().labels.push_back(std::move(labels_));
        to_.finish();
    }

private:
    static constexpr number_encoding encoding{.comment = '#'};
    static constexpr number_type integer = number_type::int32;

    std::string name_of(const companion_file& companion) const
    {
        const std::string& path = to_.in().path();
        const auto stem = path.ends_with(".node") ? path.substr(0, path.size() - 5) : path;
        return stem + companion.extension;
    }

    void read_nodes()
    {
        to_.in().require_text();
        const long long count = nodes_.integer(integer, "the number of points");
        const long long d = nodes_.integer(integer, "the dimension");
        if (d != 2 && d != 3) nodes_.fail("dimension " + std::to_string(d) + "; it must be 2 or 3");
        const long long attributes = optional(nodes_), markers = optional(nodes_);
        const std::size_t n = nodes_.fitting(count, "the number of points", static_cast<std::size_t>(2 * (d + 1)));
        if (n == 0) nodes_.fail("no points; a mesh needs some");
        to_.set_places({}, false, static_cast<int>(d));
        to_.reserve_points(n);
        tagged_vertices groups;
        for (std::size_t v = 0; v < n; ++v)
        {
            to_.add_id(nodes_.integer(integer, "the number of a point"));
            to_.add_point(nodes_);
            for (long long k = 0; k < attributes; ++k) nodes_.real(number_type::float64);
            if (markers == 0) continue;
            const auto vertex = static_cast<idx>(v);
            groups.add(marker(nodes_), 0, {&vertex, 1});
        }
        to_.finish_ids(nodes_);
        groups.move_to_prefixed(to_.file(), "points");
    }

    /// A number on the line, 0 if there is none.
    static long long optional(number_source& from)
    {
        const long long n = from.in().content_ends() ? 0 : from.integer(integer, "a count");
        if (n < 0) from.fail("a negative count; count from 0");
        return n;
    }

    /// Some programs write 0.0 for 0.
    static long long marker(number_source& from)
    {
        const double x = from.real(number_type::float64);
        if (x != std::floor(x) || std::abs(x) > 1e15) from.fail("a boundary marker that is no whole number; write one");
        return static_cast<long long>(x);
    }

    template <std::size_t N>
    void read_cell(number_source& from, std::array<idx, N>& corners, std::size_t count)
    {
        from.integer(integer, "the number of an element");
        for (std::size_t k = 0; k < count; ++k) corners[k] = to_.point_of_id(from.integer(integer, "a point"), from);
    }

    void read_elements(number_source& from)
    {
        const std::size_t n = from.count(integer, "the number of elements", 2);
        const long long corners = from.integer(integer, "the number of corners");
        const cell_kind kind = to_.file().places.per_point == 2 ? cell_kind::triangle : cell_kind::tetrahedron;
        if (corners != shape_of(kind).corners)
            from.fail(std::to_string(corners) + " corners an element; " + shape_of(kind).names + " have " +
                      std::to_string(shape_of(kind).corners) + " (second order, -o2, is not read)");
        const long long attributes = optional(from);
        std::array<idx, 4> cell{};
        const auto used = std::span(cell).first(static_cast<std::size_t>(corners));
        tagged_vertices groups;
        for (std::size_t c = 0; c < n; ++c)
        {
            read_cell(from, cell, used.size());
            to_.add_cell(kind, used);
            long long label = 0;
            for (long long k = 0; k < attributes; ++k)
            {
                const double a = from.real(number_type::float64);
                if (k > 0 || a != std::floor(a) || std::abs(a) >= 1e15) continue;
                label = static_cast<long long>(a);
                groups.add(label, shape_of(kind).dimension, used);
            }
            labels_.values.push_back(label);
        }
        groups.move_to_prefixed(to_.file(), shape_of(kind).names);
    }

    void read_faces(number_source& from)
    {
        const std::size_t n = from.count(integer, "the number of faces", 2);
        const bool marked = optional(from) != 0;
        std::array<idx, 3> face{};
        tagged_vertices groups;
        for (std::size_t c = 0; c < n; ++c)
        {
            read_cell(from, face, 3);
            to_.add_cell(cell_kind::triangle, face);
            labels_.values.push_back(marked ? marker(from) : 0);
            if (marked) groups.add(labels_.values.back(), 2, face);
            from.in().next_line(); // TetGen -nn adds neighbours
        }
        groups.move_to_prefixed(to_.file(), "faces");
    }

    volume_label labels_{"attribute", true, {}}; ///< of elements the first attribute, of faces the marker
    volume_builder to_;
    number_source nodes_;
};

} // namespace taut::io::impl
