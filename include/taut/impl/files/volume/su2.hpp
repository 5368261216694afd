// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/vtk_cells.hpp>

namespace taut::io::impl
{

/// Reads SU2's .su2: lines KEY= VALUE, behind some of which items follow, one per line; comments from %. Kinds and
/// corners are VTK's. What stands behind the numbers of an item is passed over. A file of several zones (NZONE=) has
/// a mesh behind each IZONE=, of which volume_file::zone says the one to be read.
class su2_reader
{
public:
    explicit su2_reader(volume_file& file) : to_(file), in_(to_.in()), from_(in_, {.comment = '%'}) {}

    void read()
    {
        in_.require_text();
        find_keys();
        choose_zone();
        read_points();
        for (std::size_t k = 0; k < zone_.size(); ++k)
            if (zone_[k].name == "NELEM")
                read_cells(zone_[k], {}, nullptr);
            else if (zone_[k].name == "MARKER_TAG")
                read_marker(zone_.subspan(k));
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
            const std::string_view line = in_.rest_of_line();
            const auto equals = line.find('=');
            if (equals == line.npos || line.substr(0, equals).find('%') != line.npos) continue;
            std::string_view name = line.substr(0, equals);
            name = name.substr(0, name.find_last_not_of(" \t") + 1);
            keys_.push_back({name, line.data() + equals + 1});
        }
    }

    /// Keeps the keys of the zone that is asked for.
    void choose_zone()
    {
        const std::span<const key> all(keys_);
        std::vector<std::size_t> begins; // of the keys of each zone
        for (std::size_t k = 0; k < all.size(); ++k)
            if (all[k].name == "IZONE") begins.push_back(k);
        head_ = all.first(begins.empty() ? all.size() : begins.front());
        zone_ = all;
        const long long asked = to_.file().zone;
        const key* const count = find("NZONE");
        const long long zones = count != nullptr ? value_of(*count) : std::max<long long>(1, std::ssize(begins));
        if (zones < 1 || (std::ssize(begins) != zones && !(zones == 1 && begins.empty())))
            in_.fail("NZONE= " + std::to_string(zones) + ", but " + std::to_string(begins.size()) +
                     (begins.size() == 1 ? " zone begins" : " zones begin") +
                     " with IZONE=; correct the number, or complete the file");
        if (zones > 1 && asked == 0)
            in_.fail(std::to_string(zones) + " zones; say which one is meant: --zone N, from 1 to " +
                     std::to_string(zones));
        if (asked > zones)
            in_.fail("zone " + std::to_string(asked) + " of " + std::to_string(zones) + "; they count from 1");
        if (begins.empty()) return;
        // Zones may have any order.
        std::vector<std::size_t> found(static_cast<std::size_t>(zones), all.size());
        for (const std::size_t k : begins)
        {
            const long long number = value_of(all[k]);
            if (number < 1 || number > zones)
                in_.fail("IZONE= " + std::to_string(number) + " of " + std::to_string(zones) +
                         (zones == 1 ? " zone" : " zones") + "; they count from 1");
            if (std::exchange(found[static_cast<std::size_t>(number - 1)], k) != all.size())
                in_.fail("zone " + std::to_string(number) + " is there twice; number each once");
        }
        const std::size_t first = found[static_cast<std::size_t>(std::max<long long>(1, asked) - 1)] + 1;
        const auto next = std::upper_bound(begins.begin(), begins.end(), first - 1);
        zone_ = all.subspan(first, (next == begins.end() ? all.size() : *next) - first);
        if (zones > 1)
            to_.file().notes.push_back("zone " + std::to_string(asked) + " of " + std::to_string(zones) +
                                       ": the others stay as they are");
    }

    long long value_of(const key& k)
    {
        in_.go_to(k.value);
        return in_.integer(("the value of " + std::string(k.name)).c_str());
    }

    const key* find(std::string_view name) const
    {
        for (const key& k : zone_)
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
        const key* dimension = find("NDIME");
        for (const key& k : head_) // of all zones
            if (dimension == nullptr && k.name == "NDIME") dimension = &k;
        const long long d = value_of(dimension != nullptr ? *dimension : required("NDIME"));
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

    /// behind: the keys behind that of the number; of a marker SEND_RECV= may come first, which says with whom a part
    /// of a partition exchanges these elements.
    void read_cells(const key& k, std::span<const key> behind, tagged_vertices* marker)
    {
        const std::size_t n = from_.fitting(value_of(k), "the number of elements", 2);
        in_.next_line();
        from_.skip();
        if (!behind.empty() && behind.front().name == "SEND_RECV" && in_.position() == behind.front().name.data())
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

    /// A name, on the next lines the number of its elements, before or behind that SEND_RECV= perhaps, and these.
    /// keys: from that of the name on
    void read_marker(std::span<const key> keys)
    {
        in_.go_to(keys[0].value);
        std::string_view name = in_.rest_of_line();
        name = name.substr(0, name.find_first_of(" \t%"));
        keys = keys.subspan(1);
        if (!keys.empty() && keys[0].name == "SEND_RECV") keys = keys.subspan(1);
        if (keys.empty() || keys[0].name != "MARKER_ELEMS") in_.fail("no MARKER_ELEMS= behind MARKER_TAG=");
        if (name == "SEND_RECEIVE") return; // of a partition
        tagged_vertices marker;
        ++markers_read_;
        read_cells(keys[0], keys.subspan(1), &marker);
        marker.move_to(to_.file(), [&](long long) { return std::string(name); });
    }

    volume_builder to_;
    scanner& in_;
    number_source from_;
    std::vector<key> keys_;
    std::span<const key> head_, zone_;         ///< before the first zone, and of the one that is read
    volume_label markers_{"marker", true, {}}; ///< of cells: 0 or the number of their marker, from 1
    long long markers_read_ = 0;
};

} // namespace taut::io::impl
