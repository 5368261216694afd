// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/vtk_cells.hpp>

namespace taut::io::impl
{

/// Reads legacy VTK files of unstructured grids, versions 1 to 5.1, text or binary (big-endian). Of attributes behind
/// the first part that it does not know nothing is read, which the notes say.
class vtk_reader
{
public:
    explicit vtk_reader(volume_file& file) : to_(file), in_(to_.in()), from_(in_, {}) {}

    void read()
    {
        read_header();
        while (read_part())
        {
        }
        if (to_.file().points.empty())
            in_.fail(unread_.empty() ? "no POINTS; a mesh needs some"
                                     : "no POINTS before '" + unread_ +
                                           "', a type of values that is not known; save the mesh without them");
        if (cells_first_) check_corners();
        cells_.move_to(to_, from_);
        for (const auto& a : attributes_) add_attribute_groups(to_.file(), a);
        to_.file().labels = std::move(attributes_);
        to_.finish();
    }

private:
    void read_header()
    {
        if (in_.rest_of_line().substr(0, 22) != "# vtk DataFile Version")
            in_.fail("not a VTK file: it does not start with '# vtk DataFile Version'; name it after the format that "
                     "it has");
        in_.next_line();
        in_.next_line(); // the title
        in_.skip_space();
        const auto encoding = in_.word();
        if (!same_letters(encoding, "ASCII") && !same_letters(encoding, "BINARY"))
            in_.fail("neither ASCII nor BINARY; the third line says which");
        encoding_ = {.text = same_letters(encoding, "ASCII"), .order = std::endian::big};
        from_ = number_source(in_, encoding_);
        if (encoding_.text) in_.require_text();
        in_.skip_space();
        if (!same_letters(in_.word(), "DATASET") || !same_letters(in_.word(), "UNSTRUCTURED_GRID"))
            in_.fail("no DATASET UNSTRUCTURED_GRID; save the mesh as one, other data sets hold no cells that could be "
                     "moved");
    }

    /// False at the end of what can be read.
    bool read_part()
    {
        in_.skip_space();
        const std::string key = next_key();
        if (key == "POINTS")
            read_points();
        else if (key == "CELLS")
            read_cells();
        else if (key == "CELL_TYPES")
            read_types();
        else if (key == "CELL_DATA" || key == "POINT_DATA")
        {
            of_cells_ = key == "CELL_DATA";
            tuples_ = header_count("the number of tuples");
        }
        else if (key == "METADATA")
            skip_metadata();
        else if (key == "FIELD")
            return read_field();
        else if (!key.empty())
            return read_attribute(key);
        return !in_.done();
    }

    /// VTK takes keywords in letters of any case.
    std::string next_key()
    {
        std::string key(in_.word().substr(0, 64));
        for (char& c : key) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
        return key;
    }

    /// To the empty line that ends them.
    void skip_metadata()
    {
        do in_.next_line();
        while (!in_.line_ends());
    }

    std::size_t header_count(const char* what) { return from_.fitting(in_.integer(what), what); }

    static std::optional<number_type> type_of(std::string_view name)
    {
        static constexpr std::array<std::pair<std::string_view, number_type>, 22> known = {{
            {"char", number_type::int8},
            {"signed_char", number_type::int8},
            {"unsigned_char", number_type::uint8},
            {"short", number_type::int16},
            {"unsigned_short", number_type::uint16},
            {"int", number_type::int32},
            {"vtkIdType", number_type::int32}, // VTK writes them with 4 bytes
            {"unsigned_int", number_type::uint32},
            {"long", number_type::int64},
            {"vtktypeint64", number_type::int64},
            {"unsigned_long", number_type::uint64},
            {"vtktypeuint64", number_type::uint64},
            {"vtktypeint8", number_type::int8}, // as VTK writes arrays of a fixed width
            {"vtktypeuint8", number_type::uint8},
            {"vtktypeint16", number_type::int16},
            {"vtktypeuint16", number_type::uint16},
            {"vtktypeint32", number_type::int32},
            {"vtktypeuint32", number_type::uint32},
            {"vtktypefloat32", number_type::float32},
            {"vtktypefloat64", number_type::float64},
            {"float", number_type::float32},
            {"double", number_type::float64},
        }};
        for (const auto& [word, type] : known)
            if (same_letters(word, name)) return type;
        return std::nullopt;
    }

    number_type required_type()
    {
        const std::string_view name = in_.word();
        if (const auto type = type_of(name)) return *type;
        in_.fail("unknown type '" + std::string(name.substr(0, 40)) + "'; save the values as int, float or double");
    }

    void read_points()
    {
        if (!to_.file().points.empty()) in_.fail("a second POINTS; join the two");
        const std::size_t n = header_count("the number of points");
        const number_type type = required_type();
        if (!is_real(type)) in_.fail("points of integers cannot be moved; save them as float or double");
        to_.set_places(encoding_, type == number_type::float32, 3);
        in_.next_line();
        from_.fitting(static_cast<long long>(n), "the number of points", bytes_of(type, 3));
        to_.reserve_points(n);
        for (std::size_t v = 0; v < n; ++v) to_.add_point(from_);
    }

    /// The least that some numbers take.
    std::size_t bytes_of(number_type type, std::size_t count) const
    {
        return count * (encoding_.text ? 2 : size_of(type));
    }

    /// Points may stand behind cells, and are then checked later.
    idx read_corner(number_type type)
    {
        const long long v = from_.integer(type, "a vertex");
        if (!to_.file().points.empty()) return to_.point_at(v, 0, from_);
        cells_first_ = true;
        return v < 0 || v > std::numeric_limits<idx>::max() ? -1 : static_cast<idx>(v);
    }

    void check_corners()
    {
        in_.go_to(cells_begin_);
        for (const idx v : cells_.corners) to_.point_at(v, 0, from_);
    }

    void read_cells()
    {
        const std::size_t n = header_count("the number of cells"), size = header_count("the size of the cells");
        in_.next_line();
        cells_begin_ = in_.position();
        if (starts_offsets()) return read_offsets(n, size);
        for (std::size_t c = 0; c < n; ++c)
        {
            const long long corners = from_.integer(number_type::int32, "the number of corners");
            if (corners < 0 || corners > 8)
                from_.fail("cell " + std::to_string(c) + " has " + std::to_string(corners) +
                           " corners; cells of more than 8 are not read, split them");
            for (long long k = 0; k < corners; ++k) cells_.corners.push_back(read_corner(number_type::int32));
            cells_.ends.push_back(static_cast<long long>(cells_.corners.size()));
        }
    }

    /// Returns whether the next word is OFFSETS. Binary numbers have blanks where they like.
    bool starts_offsets()
    {
        const char* const begin = in_.position();
        if (encoding_.text) from_.skip();
        const bool found = same_letters(in_.word(), "OFFSETS");
        in_.go_to(begin);
        if (found && encoding_.text) from_.skip();
        return found;
    }

    /// CELLS of version 5: n offsets, from 0, and the corners.
    void read_offsets(std::size_t n, std::size_t size)
    {
        in_.word();
        const number_type offset_type = required_type();
        in_.next_line();
        for (std::size_t c = 0; c < n; ++c)
        {
            const long long end = from_.integer(offset_type, "an offset");
            if (c > 0) cells_.ends.push_back(end);
        }
        in_.skip_space();
        if (!same_letters(in_.word(), "CONNECTIVITY"))
            in_.fail("no CONNECTIVITY behind OFFSETS; the counts of CELLS and the offsets have to agree");
        const number_type type = required_type();
        in_.next_line();
        for (std::size_t k = 0; k < size; ++k) cells_.corners.push_back(read_corner(type));
    }

    void read_types()
    {
        const std::size_t n = header_count("the number of cell types");
        in_.next_line();
        for (std::size_t c = 0; c < n; ++c)
        {
            const long long type = from_.integer(number_type::int32, "the type of a cell");
            kind_of_vtk(type, from_);
            cells_.types.push_back(static_cast<int>(type));
        }
    }

    /// Reads an array of attributes, or passes over it.
    void read_values(const std::string& name, number_type type, std::size_t components, std::size_t tuples)
    {
        in_.next_line();
        const std::size_t n =
            from_.fitting(static_cast<long long>(components * tuples), "the number of values", bytes_of(type, 1));
        if (of_cells_ && components == 1 && !is_real(type))
        {
            volume_label a{name, *of_cells_, {}};
            for (std::size_t i = 0; i < n; ++i) a.values.push_back(from_.integer(type, "a value"));
            attributes_.push_back(std::move(a));
        }
        else if (encoding_.text)
            for (std::size_t i = 0; i < n; ++i) from_.skip(), in_.word();
        else
            in_.bytes(n * size_of(type));
    }

    /// Passes over values that are no numbers, or bits; false if their type is not known.
    bool pass_over(std::string_view type, std::size_t count)
    {
        const bool bits = same_letters(type, "bit"), variants = same_letters(type, "variant");
        if (!bits && !variants && !same_letters(type, "string") && !same_letters(type, "utf8_string")) return false;
        in_.next_line();
        if (bits && !encoding_.text)
        {
            in_.bytes(count / 8 + (count % 8 != 0 ? 1 : 0));
            return true;
        }
        from_.fitting(static_cast<long long>(count), "the number of values");
        for (std::size_t i = 0; i < count; ++i)
            if (bits)
                from_.skip(), in_.word();
            else if (variants || encoding_.text) // a line each; variants in binary files, too
                in_.next_line();
            else
                pass_string();
        return true;
    }

    /// A string of a binary file, behind its length: the first two bits say in how many bytes this is.
    void pass_string()
    {
        static constexpr std::array<std::size_t, 4> more = {7, 3, 1, 0};
        const auto first = static_cast<unsigned char>(in_.bytes(1)[0]);
        std::size_t length = first % 64;
        for (const char c : in_.bytes(more[first / 64])) length = 256 * length + static_cast<unsigned char>(c);
        in_.bytes(length);
    }

    bool read_field()
    {
        in_.word(); // its name
        const std::size_t arrays = header_count("the number of arrays");
        for (std::size_t k = 0; k < arrays; ++k)
        {
            in_.skip_space();
            std::string name(in_.word());
            if (same_letters(name, "METADATA")) // of the array before
            {
                skip_metadata();
                in_.skip_space();
                name = in_.word();
            }
            const std::size_t components = header_count("the number of components");
            const std::size_t tuples = header_count("the number of tuples");
            const std::string_view word = in_.word();
            if (const auto type = type_of(word))
                read_values(name, *type, components, tuples);
            else if (!pass_over(word, components * tuples))
                return stop(word);
        }
        return true;
    }

    bool read_attribute(std::string_view key)
    {
        const std::string name(in_.word());
        if (key == "LOOKUP_TABLE" || key == "COLOR_SCALARS")
        {
            const std::size_t n = header_count("the number of values");
            const bool table = key == "LOOKUP_TABLE";
            read_values(name, encoding_.text ? number_type::float32 : number_type::uint8, table ? 4 : n,
                        table ? n : tuples_);
            return true;
        }
        const bool coordinates = key == "TEXTURE_COORDINATES";
        const std::size_t given = coordinates ? header_count("the number of components") : 1;
        const std::string_view word = in_.word();
        const auto type = type_of(word);
        const std::size_t components = key == "SCALARS"                               ? scalar_components()
                                       : key == "GLOBAL_IDS" || key == "PEDIGREE_IDS" ? 1
                                       : key == "VECTORS" || key == "NORMALS"         ? 3
                                       : key == "TENSORS"                             ? 9
                                       : key == "TENSORS6"                            ? 6
                                       : coordinates                                  ? given
                                                                                      : 0;
        if (components == 0) return stop(key);
        if (type)
            read_values(name, *type, components, tuples_);
        else if (!pass_over(word, components * tuples_))
            return stop(word);
        return true;
    }

    /// The rest of the line of SCALARS, and the line of its table.
    std::size_t scalar_components()
    {
        const std::size_t n = in_.line_ends() ? 1 : header_count("the number of components");
        in_.next_line();
        const char* const values = in_.position();
        if (same_letters(in_.word(), "LOOKUP_TABLE"))
            in_.word();
        else
            in_.go_to(values - 1); // its line end
        return n;
    }

    bool stop(std::string_view at)
    {
        unread_ = at.substr(0, 40);
        to_.file().notes.push_back("attributes from '" + unread_ + "' on were not read; groups in them are not known");
        return false;
    }

    volume_builder to_;
    scanner& in_;
    number_encoding encoding_;
    number_source from_;
    vtk_cells cells_;
    std::vector<volume_label> attributes_;
    const char* cells_begin_ = nullptr;
    bool cells_first_ = false;
    std::optional<bool> of_cells_; ///< what attributes belong to; nothing before CELL_DATA and POINT_DATA
    std::size_t tuples_ = 0;
    std::string unread_; ///< where reading stopped
};

} // namespace taut::io::impl
