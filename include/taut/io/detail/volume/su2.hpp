// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/io/detail/volume/vtk_cells.hpp>

namespace taut::io::detail
{

/// Reads SU2's .su2: lines KEY= VALUE, behind some of which items follow, one a line; comments from %. Kinds and
/// corners are VTK's. What stands
/// behind the numbers of an item is passed over.
class su2_reader
{
public:
    explicit su2_reader(volume_file& file) : to_(file), in_(to_.in()), from_(in_, {.comment = '%'}) {}

    void read()
    {
        in_.require_text();
        find_keys();
        read_points();
        for (const key& k : keys_)
            if (k.name == "NELEM")
                read_cells(k, nullptr);
            else if (k.name == "MARKER_TAG")
                read_marker(k);
        to_.file().labels.push_back(std::move(markers_));
        to_.finish();
    }

private:
    struct key
    {
        std::string_view name;
        const char* value;
    };

    void find_keys()
    {
        for (from_.skip(); !in_.done(); from_.skip())
        {
            const char* const begin = in_.position();
            const std::string_view line = in_.rest_of_line();
            const auto equals = line.find('=');
            if (equals == line.npos || line.substr(0, equals).find('%') != line.npos) continue;
            std::string_view name = line.substr(0, equals);
            name = name.substr(0, name.find_last_not_of(" \t") + 1);
            keys_.push_back({name, line.data() + equals + 1});
            if (name == "NZONE" && value_of(keys_.back()) != 1)
            {
                in_.go_to(begin);
                in_.fail("several zones; give each a file of its own");
            }
        }
    }

    long long value_of(const key& k)
    {
        in_.go_to(k.value);
        return in_.integer(("the value of " + std::string(k.name)).c_str());
    }

    const key* find(std::string_view name) const
    {
        for (const key& k : keys_)
            if (k.name == name) return &k;
        return nullptr;
    }

    const key& required(std::string_view name)
    {
        if (const key* k = find(name)) return *k;
        in_.fail("not an SU2 mesh: there is no " + std::string(name) + "=");
    }

    void read_points()
    {
        const long long d = value_of(required("NDIME"));
        if (d != 2 && d != 3) in_.fail("NDIME= " + std::to_string(d) + "; it must be 2 or 3");
        to_.set_places({}, false, static_cast<int>(d));
        const long long count = value_of(required("NPOIN"));
        const std::size_t n = from_.fitting(count, "NPOIN", static_cast<std::size_t>(2 * d));
        in_.next_line();
        to_.reserve_points(n);
        for (std::size_t v = 0; v < n; ++v)
        {
            to_.add_point(from_);
            in_.next_line();
        }
    }

    void read_cells(const key& k, tagged_vertices* marker)
    {
        const std::size_t n = from_.fitting(value_of(k), "the number of elements", 2);
        in_.next_line();
        std::array<idx, 8> corners{};
        for (std::size_t c = 0; c < n; ++c)
        {
            const long long type = from_.integer(number_type::int32, "the type of an element");
            if (type == vtk_pixel || type == vtk_voxel)
                from_.fail("element type " + std::to_string(type) + " is none of SU2");
            const cell_kind kind = kind_of_vtk(type, from_);
            const auto cell = std::span(corners).first(static_cast<std::size_t>(shape_of(kind).corners));
            for (idx& v : cell) v = to_.point_at(from_.integer(number_type::int32, "a point"), 0, from_);
            in_.next_line();
            to_.add_vtk_cell(kind, cell);
            markers_.values.push_back(marker != nullptr ? markers_read_ : 0);
            if (marker != nullptr) marker->add(0, shape_of(kind).dimension, cell);
        }
    }

    /// A name, on the next lines the number of its elements (and SEND_RECV), and these.
    void read_marker(const key& k)
    {
        in_.go_to(k.value);
        std::string_view name = in_.rest_of_line();
        name = name.substr(0, name.find_first_of(" \t%"));
        const key* const elements = &k + 1 != keys_.data() + keys_.size() ? &k + 1 : nullptr;
        if (elements == nullptr || elements->name != "MARKER_ELEMS") in_.fail("no MARKER_ELEMS= behind MARKER_TAG=");
        if (name == "SEND_RECEIVE") return; // of a partition
        tagged_vertices marker;
        ++markers_read_;
        read_cells(*elements, &marker);
        marker.move_to(to_.file(), [&](long long) { return std::string(name); });
    }

    volume_builder to_;
    scanner& in_;
    number_source from_;
    std::vector<key> keys_;
    volume_label markers_{"marker", true, {}}; ///< of cells: 0 or the number of their marker, from 1
    long long markers_read_ = 0;
};

} // namespace taut::io::detail
