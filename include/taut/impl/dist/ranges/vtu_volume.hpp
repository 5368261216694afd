// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/ranged_volume.hpp>
#include <taut/impl/dist/ranges/su2_lines.hpp>
#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/volume/xml.hpp>

namespace taut::dist::impl
{

/// A grid of VTK's XML files whose arrays are appended as they are: uncompressed, points in double precision.
class vtu_volume : public ranged_volume
{
public:
    /// Collective. Throws unsuited.
    vtu_volume(const communicator& all, const std::filesystem::path& path) : ranged_volume(all), file_(all, path)
    {
        suited(all_,
               [this]
               {
                   read_head();
                   points_ = &required("Points", "");
                   read_points();
                   read_cells();
               });
        bound();
        finish_cells();
        find_groups();
    }

    std::vector<std::int64_t> members(std::size_t group) const override
    {
        const auto& [a, value] = *std::next(values_.begin(), static_cast<std::ptrdiff_t>(group));
        std::vector<std::int64_t> places;
        suited(all_, [&, a = a, value = value] { places = with_value(arrays_[a], value); });
        return at_home(std::move(places));
    }

    labelled_cells labelled() const override
    {
        std::map<std::size_t, std::set<std::int64_t>> of_array;
        for (const auto& [a, value] : values_)
            if (arrays_[a].section == "CellData") of_array[a].insert(value);
        label_tuples labels(0);
        suited(all_, [&] { labels = labels_of(of_array); });
        return labels.numbered(all_);
    }

    outputs write(const std::filesystem::path& path, const std::vector<vec3>& x) const override
    {
        outputs files;
        auto file = std::make_unique<shared_output>(all_, path);
        const auto P = all_.ranks(), r = static_cast<std::size_t>(all_.rank());
        const std::size_t begin = file_.size / P * r + file_.size % P * r / P,
                          end = file_.size / P * (r + 1) + file_.size % P * (r + 1) / P;
        all_.together(
            [&]
            {
                copy(*file, begin, std::min(end, points_->data));
                copy(*file, std::max(begin, points_->data + points_->bytes), end);
                std::string bytes(x.size() * 24, '\0');
                for (std::size_t v = 0; v < x.size(); ++v)
                    for (int k = 0; k < 3; ++k)
                        io::impl::store(bytes.data() + 24 * v + 8 * static_cast<std::size_t>(k), x[v][k], order_);
                file->write(points_->data + 24 * static_cast<std::size_t>(first()), bytes);
            });
        file->close();
        files.push_back(std::move(file));
        return files;
    }

private:
    struct array
    {
        std::string section, name, type;
        std::size_t components, data, bytes; ///< data: place of its first number in the file
    };

    void read_head()
    {
        std::string head;
        for (std::size_t most = 1 << 16;; most *= 4)
        {
            head = file_.bytes(0, most);
            const auto at = head.find("<AppendedData");
            if (at != head.npos && head.find('_', head.find('>', at)) != head.npos) break;
            if (most > std::size_t{1} << 24U || most > file_.size) throw unsuited("its arrays are not appended");
        }
        std::string section;
        std::size_t header = 4;
        io::impl::xml_tags tags(head);
        std::vector<array> arrays;
        while (const auto tag = tags.next())
        {
            const auto is = [&](std::string_view key, std::string_view otherwise, std::string_view wanted)
            { return tag->attribute_or(key, otherwise) == wanted; };
            if (tag->name == "VTKFile")
            {
                if (!is("type", "", "UnstructuredGrid") || !is("compressor", "", ""))
                    throw unsuited("it is compressed");
                order_ = is("byte_order", "LittleEndian", "BigEndian") ? std::endian::big : std::endian::little;
                header = is("header_type", "UInt32", "UInt64") ? 8 : 4;
            }
            else if (tag->name == "Piece")
            {
                if (pieces_++ > 0) throw unsuited("it has several pieces");
                point_count_ = number(tag->attribute_or("NumberOfPoints", ""));
                cell_count_ = number(tag->attribute_or("NumberOfCells", ""));
            }
            else if (tag->name == "DataArray" || tag->name == "Array")
            {
                if (section == "FieldData" && !is("format", "ascii", "appended")) continue; // stays as it is
                if (!is("format", "ascii", "appended")) throw unsuited("its arrays are not appended");
                arrays.push_back(
                    {section, std::string(tag->attribute_or("Name", "")), std::string(tag->attribute_or("type", "")),
                     number(tag->attribute_or("NumberOfComponents", "1")), number(tag->attribute_or("offset", "")), 0});
            }
            else if (tag->name == "AppendedData")
            {
                if (!is("encoding", "base64", "raw")) throw unsuited("its arrays are in base64");
                locate(std::move(arrays), head.find('_', tag->end) + 1, header);
                return;
            }
            else if (!tag->name.starts_with('/'))
                section = tag->name;
        }
        throw unsuited("its arrays are not appended");
    }

    static std::size_t number(std::string_view text)
    {
        std::size_t n = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), n);
        if (failure != std::errc{} || end != text.data() + text.size() || n > (std::size_t{1} << 48U))
            throw unsuited("a count is missing");
        return n;
    }

    void locate(std::vector<array> arrays, std::size_t begin, std::size_t header)
    {
        for (auto& a : arrays)
        {
            const std::size_t at = begin + a.data;
            const std::string count = file_.bytes(at, header);
            if (count.size() != header) throw unsuited("an offset is behind its end");
            a.bytes = header == 8 ? static_cast<std::size_t>(io::impl::load<std::uint64_t>(count.data(), order_))
                                  : io::impl::load<std::uint32_t>(count.data(), order_);
            a.data = at + header;
            if (a.bytes > file_.size - a.data) throw unsuited("an array is longer than the file");
            arrays_.push_back(std::move(a));
        }
        for (const auto& a : arrays_)
            for (const auto& b : arrays_)
                if (a.section == "Points" && &a != &b && a.data < b.data + b.bytes && b.data < a.data + a.bytes)
                    throw unsuited("an array has bytes of the points");
    }

    const array& required(std::string_view section, std::string_view name) const
    {
        for (const auto& a : arrays_)
            if (a.section == section && (name.empty() || a.name == name)) return a;
        throw unsuited("an array is missing");
    }

    std::pair<std::size_t, std::size_t> share(std::size_t n) const
    {
        const auto P = all_.ranks(), r = static_cast<std::size_t>(all_.rank());
        return {n / P * r + n % P * r / P, n / P * (r + 1) + n % P * (r + 1) / P};
    }

    void read_points()
    {
        const auto& a = *points_;
        if (a.type != "Float64" || a.components != 3 || a.bytes / 24 != point_count_ || a.bytes % 24 != 0)
            throw unsuited("its points are not in double precision");
        const auto [begin, end] = share(point_count_);
        const std::string bytes = file_.bytes(a.data + 24 * begin, 24 * (end - begin));
        for (std::size_t v = begin; v < end; ++v)
        {
            vec3 p;
            for (int k = 0; k < 3; ++k)
                p[k] =
                    io::impl::load<double>(bytes.data() + 24 * (v - begin) + 8 * static_cast<std::size_t>(k), order_);
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                throw unsuited("a point is not finite");
            piece.ids.push_back(static_cast<std::int64_t>(v));
            piece.points.push_back(p);
        }
    }

    template <class T>
    void append(std::vector<std::int64_t>& to, const std::string& bytes) const
    {
        for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T))
            to.push_back(static_cast<std::int64_t>(io::impl::load<T>(bytes.data() + at, order_)));
    }

    static std::size_t size_of(const array& a)
    {
        static constexpr std::array<std::pair<std::string_view, std::size_t>, 8> sizes = {{{"Int8", 1},
                                                                                           {"UInt8", 1},
                                                                                           {"Int16", 2},
                                                                                           {"UInt16", 2},
                                                                                           {"Int32", 4},
                                                                                           {"UInt32", 4},
                                                                                           {"Int64", 8},
                                                                                           {"UInt64", 8}}};
        for (const auto& [type, size] : sizes)
            if (type == a.type) return size;
        return 0;
    }

    std::vector<std::int64_t> integers(const array& a, std::size_t begin, std::size_t end) const
    {
        const std::size_t each = size_of(a);
        if (each == 0 || end > a.bytes / each || begin > end)
            throw unsuited("an array has not as many integers as it needs");
        const std::string bytes = file_.bytes(a.data + each * begin, each * (end - begin));
        std::vector<std::int64_t> result;
        result.reserve(end - begin);
        const bool is_signed = a.type[0] == 'I';
        if (each == 1) is_signed ? append<std::int8_t>(result, bytes) : append<std::uint8_t>(result, bytes);
        if (each == 2) is_signed ? append<std::int16_t>(result, bytes) : append<std::uint16_t>(result, bytes);
        if (each == 4) is_signed ? append<std::int32_t>(result, bytes) : append<std::uint32_t>(result, bytes);
        if (each == 8) is_signed ? append<std::int64_t>(result, bytes) : append<std::uint64_t>(result, bytes);
        return result;
    }

    /// Calls f(number among the cells, kind, corners) for the cells of this process.
    template <class F>
    void each_cell(const F& f) const
    {
        const auto [begin, end] = share(cell_count_);
        if (begin == end) return;
        const auto types = integers(required("Cells", "types"), begin, end);
        const auto ends = integers(required("Cells", "offsets"), begin == 0 ? 0 : begin - 1, end);
        const std::size_t before = begin == 0 ? 0 : static_cast<std::size_t>(ends.front()), skip = begin == 0 ? 0 : 1;
        if (ends.back() < 0 || static_cast<std::size_t>(ends.back()) < before) throw unsuited("offsets do not ascend");
        const auto corners = integers(required("Cells", "connectivity"), before, static_cast<std::size_t>(ends.back()));
        std::size_t at = 0;
        for (std::size_t c = 0; c < types.size(); ++c)
        {
            const auto kind = kind_of_vtk(types[c]);
            const auto n = static_cast<std::size_t>(io::impl::shape_of(kind).corners);
            if (static_cast<std::size_t>(ends[c + skip]) != before + at + n || at + n > corners.size())
                throw unsuited("a cell has another number of corners than its kind");
            f(c, kind, std::span(corners).subspan(at, n));
            at += n;
        }
    }

    void read_cells()
    {
        each_cell(
            [&](std::size_t, io::cell_kind kind, std::span<const std::int64_t> c)
            {
                for (const std::int64_t v : c)
                    if (v < 0 || static_cast<std::size_t>(v) >= point_count_)
                        throw unsuited("a cell names a vertex that is not there");
                if (io::impl::shape_of(kind).dimension == 3) add_solid(kind, c);
            });
    }

    bool names(const array& a) const
    {
        return (a.section == "PointData" || a.section == "CellData") && a.components == 1 && size_of(a) != 0 &&
               a.bytes / size_of(a) == (a.section == "PointData" ? point_count_ : cell_count_);
    }

    std::vector<std::int64_t> values_here(const array& a) const
    {
        const auto [begin, end] = share(a.section == "PointData" ? point_count_ : cell_count_);
        return integers(a, begin, end);
    }

    /// Collective. Groups NAME:VALUE of integer arrays of few values.
    void find_groups()
    {
        constexpr std::size_t most = 256;
        for (std::size_t k = 0; k < arrays_.size(); ++k)
        {
            if (!names(arrays_[k])) continue;
            std::vector<std::int64_t> mine;
            suited(all_,
                   [&]
                   {
                       const auto values = values_here(arrays_[k]);
                       std::set<std::int64_t> some;
                       for (const std::int64_t v : values)
                           if (some.size() <= most) some.insert(v);
                       mine.assign(some.begin(), some.end());
                   });
            const auto there = all_.gathered(mine);
            const std::set<std::int64_t> all(there.begin(), there.end());
            if (all.size() > most) continue;
            for (const std::int64_t v : all)
            {
                values_.emplace_back(k, v);
                groups.push_back(
                    {arrays_[k].name + ':' + std::to_string(v), arrays_[k].section == "PointData" ? 0 : 3});
            }
        }
    }

    /// Of arrays that do not number single cells, as io::impl::region_numbers() chooses them.
    label_tuples labels_of(const std::map<std::size_t, std::set<std::int64_t>>& values) const
    {
        std::vector<std::vector<std::int64_t>> columns;
        for (const auto& [a, all] : values)
            if (all != std::set<std::int64_t>{0} && (all.size() <= 16 || 2 * all.size() <= cell_count_))
                columns.push_back(values_here(arrays_[a]));
        label_tuples labels(columns.size());
        std::vector<std::int64_t> tuple(columns.size());
        each_cell(
            [&](std::size_t c, io::cell_kind kind, std::span<const std::int64_t> corners)
            {
                for (std::size_t k = 0; k < tuple.size(); ++k) tuple[k] = columns[k][c];
                const int dimension = io::impl::shape_of(kind).dimension;
                if (dimension == 3) labels.add_cell(tuple);
                if (dimension == 2) labels.add_face(corners, tuple);
            });
        return labels;
    }

    std::vector<std::int64_t> with_value(const array& a, std::int64_t value) const
    {
        const auto values = values_here(a);
        std::vector<std::int64_t> places;
        if (a.section == "PointData")
            for (std::size_t k = 0; k < values.size(); ++k)
                if (values[k] == value) places.push_back(first() + static_cast<std::int64_t>(k));
        if (a.section == "CellData")
            each_cell(
                [&](std::size_t c, io::cell_kind, std::span<const std::int64_t> corners)
                {
                    if (values[c] == value) places.insert(places.end(), corners.begin(), corners.end());
                });
        return places;
    }

    void copy(shared_output& to, std::size_t begin, std::size_t end) const
    {
        for (std::size_t at = begin; at < end;)
        {
            const std::string bytes = file_.bytes(at, std::min<std::size_t>(end - at, std::size_t{1} << 24U));
            to.write(at, bytes);
            at += bytes.size();
        }
    }

    shared_input file_;
    std::vector<array> arrays_;
    const array* points_ = nullptr;
    std::endian order_ = std::endian::little;
    std::size_t point_count_ = 0, cell_count_ = 0;
    int pieces_ = 0;
    std::vector<std::pair<std::size_t, std::int64_t>> values_; ///< array and value of each group
};

} // namespace taut::dist::impl
