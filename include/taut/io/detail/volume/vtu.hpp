// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/io/detail/volume/vtk_cells.hpp>
#include <taut/io/detail/volume/xml.hpp>

namespace taut::io::detail
{

/// Reads VTK's XML files of unstructured grids: one piece, arrays as text or appended raw.
class vtu_reader
{
public:
    explicit vtu_reader(volume_file& file) : to_(file), bytes_(file.bytes) {}

    void read()
    {
        find_arrays();
        read_points();
        read_cells();
        for (const auto& a : arrays_)
            if (a.section == "CellData" || a.section == "PointData") read_attribute(a);
        to_.finish();
    }

private:
    struct array
    {
        std::string_view section;
        xml_tag tag;
    };

    [[noreturn]] void fail(const xml_tag& at, const std::string& what) const
    {
        throw io_error(to_name(), what, to_.in().line_of(bytes_.data() + at.begin));
    }

    const std::string& to_name() const { return to_.in().path(); }

    void find_arrays()
    {
        static constexpr std::array<std::string_view, 5> sections = {"FieldData", "PointData", "CellData", "Points",
                                                                     "Cells"};
        xml_tags tags(bytes_);
        std::string_view section;
        bool known = false;
        while (const auto tag = tags.next())
        {
            if (tag->name == "VTKFile")
            {
                known = true;
                read_kind(*tag);
            }
            else if (tag->name == "Piece")
                read_piece(*tag);
            else if (tag->name == "DataArray")
                arrays_.push_back({section, *tag});
            else if (tag->name == "AppendedData")
            {
                find_appended(*tag); // what follows is no XML
                break;
            }
            else if (std::find(sections.begin(), sections.end(), tag->name) != sections.end())
                section = tag->name;
        }
        if (!known) throw io_error(to_name(), "not a VTU file: there is no <VTKFile>");
    }

    void read_kind(const xml_tag& tag)
    {
        if (tag.attribute_or("type", "") != "UnstructuredGrid")
            fail(tag, "not an UnstructuredGrid; other data sets hold no volume mesh that could be moved");
        binary_.text = false;
        binary_.order =
            tag.attribute_or("byte_order", "LittleEndian") == "BigEndian" ? std::endian::big : std::endian::little;
        header_ = tag.attribute_or("header_type", "UInt32") == "UInt64" ? number_type::uint64 : number_type::uint32;
        compressed_ = !tag.attribute_or("compressor", "").empty();
    }

    void read_piece(const xml_tag& tag)
    {
        if (pieces_++ > 0) fail(tag, "a second piece; merge them into one grid");
        points_ = number(tag, "NumberOfPoints");
        cells_ = number(tag, "NumberOfCells");
    }

    std::size_t number(const xml_tag& tag, std::string_view key) const
    {
        const std::string_view text = tag.attribute_or(key, "");
        std::size_t n = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), n);
        if (failure != std::errc{} || end != text.data() + text.size() || n > bytes_.size())
            fail(tag, "no " + std::string(key) + " that the file could hold");
        return n;
    }

    void find_appended(const xml_tag& tag)
    {
        raw_ = tag.attribute_or("encoding", "") == "raw";
        const auto mark = bytes_.find('_', tag.end);
        if (mark == bytes_.npos) fail(tag, "appended data do not start with _");
        appended_ = mark + 1;
    }

    number_type type_of(const array& a) const
    {
        static constexpr std::array<std::pair<std::string_view, number_type>, 10> types = {{
            {"Int8", number_type::int8},
            {"UInt8", number_type::uint8},
            {"Int16", number_type::int16},
            {"UInt16", number_type::uint16},
            {"Int32", number_type::int32},
            {"UInt32", number_type::uint32},
            {"Int64", number_type::int64},
            {"UInt64", number_type::uint64},
            {"Float32", number_type::float32},
            {"Float64", number_type::float64},
        }};
        for (const auto& [word, type] : types)
            if (word == a.tag.attribute_or("type", "")) return type;
        fail(a.tag, "an array without a known type");
    }

    /// Whether the bytes of an array can be read; nothing is wrong with one whose groups alone are lost.
    const char* obstacle(const array& a) const
    {
        const auto format = a.tag.attribute_or("format", "ascii");
        if (format == "ascii") return nullptr;
        if (compressed_) return "compressed data; save the mesh uncompressed, with ascii or raw appended data";
        if (format == "appended" && raw_) return nullptr;
        return "base64 data; save the mesh with ascii or raw appended data";
    }

    /// Calls use(source, bytes): numbers of an array. bytes: of binary numbers.
    template <class Use>
    void with_numbers(const array& a, const Use& use)
    {
        if (const char* const why = obstacle(a)) fail(a.tag, why);
        const bool text = a.tag.attribute_or("format", "ascii") == "ascii";
        const std::size_t begin = text ? a.tag.end : appended_ + number(a.tag, "offset");
        if (begin > bytes_.size()) fail(a.tag, "an offset behind the end of the file");
        const std::size_t end = text ? std::min(bytes_.find('<', begin), bytes_.size()) : bytes_.size();
        scanner in(bytes_.substr(0, end), to_name());
        in.go_to(bytes_.data() + begin);
        number_source from(in, text ? number_encoding{} : binary_);
        const std::size_t size = text ? 0 : from.count(header_, "the number of bytes");
        use(from, size);
    }

    /// Calls f(integer, source) for each integer of an array: n of them, or as many as there are.
    template <class F>
    void for_each_integer(const array& a, std::optional<std::size_t> n, const F& f)
    {
        const number_type type = type_of(a);
        with_numbers(a,
                     [&](number_source& from, std::size_t size)
                     {
                         std::size_t found = 0;
                         const std::size_t each = size_of(type), held = size / each;
                         if (!from.text() && n && held != *n)
                             from.fail(std::to_string(size) + " bytes for " + std::to_string(*n) + " integers of " +
                                       std::to_string(each));
                         for (from.skip(); from.text() ? !from.in().done() : found < held; from.skip(), ++found)
                             f(from.integer(type, "an integer"), from);
                         if (n && found != *n)
                             from.fail(std::to_string(found) + " integers where there should be " + std::to_string(*n));
                     });
    }

    const array& find(std::string_view section, std::string_view name) const
    {
        for (const auto& a : arrays_)
            if (a.section == section && (name.empty() || a.tag.attribute_or("Name", "") == name)) return a;
        throw io_error(to_name(), "no array " + std::string(name) + " in <" + std::string(section) + ">; add it");
    }

    void read_points()
    {
        const array& a = find("Points", "");
        const number_type type = type_of(a);
        if (!is_real(type)) fail(a.tag, "points of integers cannot be moved; save them as Float32 or Float64");
        if (a.tag.attribute_or("NumberOfComponents", "3") != "3") fail(a.tag, "points need three components");
        with_numbers(a,
                     [&](number_source& from, std::size_t size)
                     {
                         const std::size_t each = 3 * (from.text() ? 2 : size_of(type));
                         from.fitting(static_cast<long long>(points_), "the number of points", each);
                         if (!from.text() && size != each * points_)
                             from.fail(std::to_string(size) + " bytes for " + std::to_string(points_) + " points");
                         to_.set_places(from.text() ? number_encoding{} : binary_, type == number_type::float32, 3);
                         to_.reserve_points(points_);
                         for (std::size_t v = 0; v < points_; ++v) to_.add_point(from);
                     });
        if (a.tag.attribute_or("format", "ascii") == "appended") require_own_bytes(a);
    }

    /// Offsets can name bytes that other arrays have, which would change with the points.
    void require_own_bytes(const array& points)
    {
        const auto [begin, end] = appended_bytes(points);
        for (const auto& other : arrays_)
        {
            if (&other == &points || other.tag.attribute_or("format", "ascii") != "appended") continue;
            const auto [first, last] = appended_bytes(other);
            if (first < end && begin < last)
                fail(other.tag,
                     "array '" + std::string(other.tag.attribute_or("Name", "")) +
                         "' has bytes of the points; save the mesh with an offset of its own for each array");
        }
    }

    /// From the header of an array to its end.
    std::pair<std::size_t, std::size_t> appended_bytes(const array& a)
    {
        std::pair<std::size_t, std::size_t> result;
        with_numbers(a,
                     [&](const number_source& from, std::size_t size)
                     {
                         const auto begin = static_cast<std::size_t>(from.in().position() - from.in().start());
                         result = {begin - size_of(header_), begin + size};
                     });
        return result;
    }

    void read_cells()
    {
        vtk_cells cells;
        for_each_integer(find("Cells", "connectivity"), {},
                         [&](long long v, const number_source& from)
                         { cells.corners.push_back(to_.point_at(v, 0, from)); });
        for_each_integer(find("Cells", "offsets"), cells_,
                         [&](long long end, const number_source&) { cells.ends.push_back(end); });
        const array& types = find("Cells", "types");
        for_each_integer(types, cells_,
                         [&](long long type, const number_source& from)
                         {
                             kind_of_vtk(type, from);
                             cells.types.push_back(static_cast<int>(type));
                         });
        to_.in().go_to(bytes_.data() + types.tag.begin);
        cells.move_to(to_, number_source(to_.in(), {}));
    }

    void read_attribute(const array& a)
    {
        const number_type type = type_of(a);
        if (is_real(type) || a.tag.attribute_or("NumberOfComponents", "1") != "1") return;
        volume_label attribute{std::string(a.tag.attribute_or("Name", "")), a.section == "CellData", {}};
        const std::size_t count = attribute.of_cells ? cells_ : points_;
        const char* why = obstacle(a);
        // Arrays that share bytes could be any number.
        if (a.tag.attribute_or("format", "ascii") != "ascii") attribute_bytes_ += count * size_of(type);
        if (why == nullptr && attribute_bytes_ > bytes_.size())
            why = "arrays of attributes have more bytes than the file, so they share them";
        if (why != nullptr)
        {
            to_.file().notes.push_back("no groups were made of '" + attribute.name + "': " + why);
            return;
        }
        for_each_integer(a, count, [&](long long x, const number_source&) { attribute.values.push_back(x); });
        add_attribute_groups(to_.file(), attribute);
        to_.file().labels.push_back(std::move(attribute));
    }

    volume_builder to_;
    std::string_view bytes_;
    std::vector<array> arrays_;
    number_encoding binary_;
    number_type header_ = number_type::uint32;
    bool compressed_ = false, raw_ = false;
    std::size_t appended_ = 0, pieces_ = 0, points_ = 0, cells_ = 0;
    std::size_t attribute_bytes_ = 0; // of appended arrays
};

} // namespace taut::io::detail
