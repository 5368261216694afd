// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/coding/array_code.hpp>
#include <taut/impl/files/volume/vtk_cells.hpp>
#include <taut/impl/files/volume/xml.hpp>

namespace taut::io::impl
{

/// Reads VTK's XML files of unstructured grids: one piece, arrays as text, in base64 or appended, compressed or not.
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
    static constexpr std::string_view blank = " \t\r\n";
    static constexpr std::size_t free_bytes = 1 << 16, most_per_byte = 256;

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
            else if (tag->name == "Array") // of strings, which have bytes, too
                arrays_.push_back({"", *tag});
            else if (tag->name == "AppendedData")
            {
                find_appended(*tag); // what follows is no XML
                break;
            }
            else if (std::find(sections.begin(), sections.end(), tag->name) != sections.end())
                section = tag->name;
        }
        if (!known)
            throw io_error(to_name(), "not a VTU file: there is no <VTKFile>; name it after the format that it has");
    }

    void read_kind(const xml_tag& tag)
    {
        if (tag.attribute_or("type", "") != "UnstructuredGrid")
            fail(tag,
                 "not an UnstructuredGrid; save the mesh as one, other data sets hold no cells that could be moved");
        binary_.text = false;
        binary_.order =
            one_of(tag, "byte_order", "LittleEndian", "BigEndian") == 1 ? std::endian::big : std::endian::little;
        header_ = one_of(tag, "header_type", "UInt32", "UInt64") == 1 ? number_type::uint64 : number_type::uint32;
        compressor_ = tag.attribute_or("compressor", "");
        for (const auto& c : compressors)
            if (c.name == compressor_) packed_ = &c;
    }

    /// Index of an attribute's value among two words, the first if it is missing.
    int one_of(const xml_tag& tag, std::string_view key, std::string_view first, std::string_view second) const
    {
        const auto word = tag.attribute_or(key, first);
        if (word != first && word != second)
            fail(tag, std::string(key) + " '" + std::string(word) + "'; it must be " + std::string(first) + " or " +
                          std::string(second));
        return word == second ? 1 : 0;
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
        if (failure != std::errc{} || end != text.data() + text.size() ||
            n > (packed_ != nullptr ? allowed() : bytes_.size()))
            fail(tag, "no " + std::string(key) + " that the file could hold; correct it, or get the file whole");
        return n;
    }

    void find_appended(const xml_tag& tag)
    {
        encoding_ = tag.attribute_or("encoding", "base64");
        const auto mark = bytes_.find('_', tag.end);
        if (mark == bytes_.npos) fail(tag, "appended data do not start with _; save the mesh again");
        appended_ = mark + 1;
    }

    static std::optional<number_type> known_type_of(const array& a)
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
        return std::nullopt;
    }

    number_type type_of(const array& a) const
    {
        if (const auto type = known_type_of(a)) return *type;
        fail(a.tag, "an array without a known type; it must be Int8 to UInt64, Float32 or Float64");
    }

    static std::string_view format_of(const array& a) { return a.tag.attribute_or("format", "ascii"); }

    static std::string name_of(const array& a)
    {
        return "array '" + std::string(a.tag.attribute_or("Name", a.section)) + "'";
    }

    /// Why the bytes of an array cannot be read, if so; nothing is wrong with one whose groups alone are lost.
    std::string obstacle(const array& a) const
    {
        const auto format = format_of(a);
        if (format == "ascii") return {};
        if (format != "binary" && format != "appended")
            return "format '" + std::string(format) + "'; it must be ascii, binary or appended";
        if (format == "appended" && appended_ == 0)
            return "appended, and there is no <AppendedData>; the file is cut off";
        if (format == "appended" && encoding_ != "raw" && encoding_ != "base64")
            return "appended in encoding '" + std::string(encoding_) + "'; it must be raw or base64";
        if (compressor_.empty() || (packed_ != nullptr && packed_->built)) return {};
        std::string known;
        for (const auto& c : compressors)
            if (c.built) known += ", or with " + std::string(c.name);
        return "compressed with " + std::string(compressor_) +
               (packed_ == nullptr
                    ? ", which is not known; save the mesh uncompressed"
                    : ", and taut was built without " + std::string(packed_->library) + "; build it with that and " +
                          std::string(packed_->macro) + ", or save the mesh uncompressed") +
               known;
    }

    bool in_place(const array& a) const
    {
        return format_of(a) == "appended" && encoding_ == "raw" && packed_ == nullptr;
    }

    std::size_t appended_at(const array& a) const
    {
        const std::size_t begin = appended_ + number(a.tag, "offset");
        if (begin > bytes_.size())
            fail(a.tag,
                 name_of(a) + ": an offset behind the end of the file; it is cut off or damaged, get or save it again");
        return begin;
    }

    /// Charges work and memory against a limit in proportion to the file.
    void charge(std::size_t n)
    {
        spent_ += n;
        if (spent_ > allowed())
            throw bad_code{"with it arrays unpack to more than " + std::to_string(most_per_byte) +
                           " times the bytes of the file, far more than a mesh does; save it uncompressed if that is "
                           "meant"};
    }

    std::size_t allowed() const { return free_bytes + most_per_byte * bytes_.size(); }

    /// Calls use(coded, begin, end): an array that is no text, and where its code lies in the file.
    template <class Use>
    void with_code(const array& a, const Use& use)
    {
        if (const std::string why = obstacle(a); !why.empty()) fail(a.tag, name_of(a) + ": " + why);
        try
        {
            const bool appended = format_of(a) == "appended";
            array_code code;
            code.base64 = !appended || encoding_ == "base64";
            code.packed = packed_ == nullptr ? compressor::none : packed_->kind;
            code.order = binary_.order;
            code.word = size_of(header_);
            std::size_t begin =
                appended ? appended_at(a) : std::min(bytes_.find_first_not_of(blank, a.tag.end), bytes_.size());
            std::string_view text = bytes_.substr(begin);
            std::string joined; // without line ends
            if (!appended)
            {
                text = text.substr(0, text.find('<'));
                text = text.substr(0, text.find_last_not_of(blank) + 1);
                if (text.find_first_of(blank) != text.npos)
                    std::copy_if(text.begin(), text.end(), std::back_inserter(joined),
                                 [](char c) { return blank.find(c) == blank.npos; });
            }
            const std::size_t length = text.size();
            if (!joined.empty()) text = joined;
            const coded_array coded(text, code, allowed() - spent_);
            charge((3 + static_cast<std::size_t>(coded.code().blocks)) * code.word);
            if (!appended && coded.length() != text.size())
                throw bad_code{std::to_string(text.size() - coded.length()) +
                               " characters more than its header says; the array is damaged"};
            use(coded, begin, begin + (appended ? coded.length() : length));
        }
        catch (const bad_code& e)
        {
            fail(a.tag, name_of(a) + ": " + e.what);
        }
    }

    /// Calls use(source, bytes): numbers of an array. bytes: of binary numbers. complaint(bytes): what is wrong with
    /// that many, asked before they are unpacked; empty: nothing.
    template <class Complaint, class Use>
    void with_numbers(const array& a, const Complaint& complaint, const Use& use)
    {
        const bool text = format_of(a) == "ascii";
        if (!text && !in_place(a))
            return with_code(a,
                             [&](const coded_array& coded, std::size_t, std::size_t)
                             {
                                 if (const std::string why = complaint(coded.size()); !why.empty()) throw bad_code{why};
                                 charge(coded.length() + coded.size());
                                 const std::string data = coded.bytes();
                                 scanner in(data, to_name());
                                 in.go_to(data.data()); // behind no byte order mark
                                 const number_origin origin{&to_.in(), bytes_.data() + a.tag.begin, name_of(a)};
                                 number_source from(in, binary_, &origin);
                                 use(from, data.size());
                             });
        if (const std::string why = obstacle(a); !why.empty()) fail(a.tag, name_of(a) + ": " + why);
        const std::size_t begin = text ? a.tag.end : appended_at(a);
        const std::size_t end = text ? std::min(bytes_.find('<', begin), bytes_.size()) : bytes_.size();
        scanner in(bytes_.substr(0, end), to_name());
        in.go_to(bytes_.data() + begin);
        number_source from(in, text ? number_encoding{} : binary_);
        const std::size_t size = text ? 0 : from.count(header_, "the number of bytes");
        if (const std::string why = text ? std::string() : complaint(size); !why.empty()) from.fail(why);
        use(from, size);
    }

    /// Calls f(integer, source) for each integer of an array: n of them, or as many as there are.
    template <class F>
    void for_each_integer(const array& a, std::optional<std::size_t> n, const F& f)
    {
        const number_type type = type_of(a);
        const std::size_t each = size_of(type);
        const auto complaint = [&](std::size_t size)
        {
            return n && size / each != *n
                       ? std::to_string(size) + " bytes for " + std::to_string(*n) + " integers of " +
                             std::to_string(each) + "; correct the counts or the array"
                       : std::string();
        };
        with_numbers(a, complaint,
                     [&](number_source& from, std::size_t size)
                     {
                         std::size_t found = 0;
                         const std::size_t held = size / each;
                         for (from.skip(); from.text() ? !from.in().done() : found < held; from.skip(), ++found)
                             f(from.integer(type, "an integer"), from);
                         if (n && found != *n)
                             from.fail(std::to_string(found) + " integers where there should be " + std::to_string(*n) +
                                       "; correct the counts or the array");
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
        if (a.tag.attribute_or("NumberOfComponents", "3") != "3")
            fail(a.tag, "points need three components; give z = 0 in the plane");
        const auto complaint = [&](std::size_t size)
        {
            return size != 3 * size_of(type) * points_
                       ? std::to_string(size) + " bytes for " + std::to_string(points_) +
                             " points; correct the counts or the array"
                       : std::string();
        };
        with_numbers(a, complaint,
                     [&](number_source& from, std::size_t)
                     {
                         const std::size_t each = 3 * (from.text() ? 2 : size_of(type));
                         from.fitting(static_cast<long long>(points_), "the number of points", each);
                         to_.set_places(from.text() ? number_encoding{} : binary_, type == number_type::float32, 3);
                         if (!from.text() && !in_place(a)) set_code(a);
                         to_.reserve_points(points_);
                         for (std::size_t v = 0; v < points_; ++v) to_.add_point(from);
                     });
        if (format_of(a) == "appended") require_own_bytes(a);
    }

    void set_code(const array& points)
    {
        with_code(points,
                  [&](const coded_array& coded, std::size_t begin, std::size_t end) {
                      to_.set_code({coded.code(), begin, end, {}});
                  });
    }

    /// Offsets can name bytes that other arrays have, which would change with the points.
    void require_own_bytes(const array& points)
    {
        const auto [begin, end] = appended_bytes(points);
        for (const auto& other : arrays_)
        {
            if (&other == &points || format_of(other) != "appended") continue;
            const auto [first, last] = appended_bytes(other);
            if (first < end && begin < last)
                fail(other.tag, name_of(other) +
                                    " has bytes of the points; save the mesh with an offset of its own for each array");
            auto& coded = to_.file().places.coded;
            if (!coded || first < end) continue;
            const std::string_view digits = other.tag.attribute_or("offset", "");
            const auto at = static_cast<std::size_t>(digits.data() - bytes_.data());
            coded->followed_by.push_back({at, at + digits.size(), number(other.tag, "offset")});
        }
    }

    /// From the header of an array to its end.
    std::pair<std::size_t, std::size_t> appended_bytes(const array& a)
    {
        std::pair<std::size_t, std::size_t> result;
        with_code(a, [&](const coded_array&, std::size_t begin, std::size_t end) { result = {begin, end}; });
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
        const auto known = known_type_of(a);
        if (!known) return; // bits and strings
        const number_type type = *known;
        if (is_real(type) || a.tag.attribute_or("NumberOfComponents", "1") != "1") return;
        volume_label attribute{std::string(a.tag.attribute_or("Name", "")), a.section == "CellData", {}};
        const std::size_t count = attribute.of_cells ? cells_ : points_;
        std::string why = obstacle(a);
        // Arrays that share bytes could be any number.
        if (format_of(a) != "ascii" && packed_ == nullptr) attribute_bytes_ += count * size_of(type);
        if (why.empty() && attribute_bytes_ > bytes_.size())
            why = "arrays of attributes have more bytes than the file, so they share them";
        if (why.empty() && format_of(a) != "ascii" && packed_ != nullptr &&
            spent_ + count * size_of(type) + 2 * bytes_.size() > allowed())
            why = "arrays of attributes unpack to far more bytes than the file has";
        if (!why.empty())
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
    std::string_view compressor_, encoding_;
    const compressor_words* packed_ = nullptr;
    std::size_t spent_ = 0; // on unpacking, in bytes
    std::size_t appended_ = 0, pieces_ = 0, points_ = 0, cells_ = 0;
    std::size_t attribute_bytes_ = 0; // of appended arrays
};

} // namespace taut::io::impl
