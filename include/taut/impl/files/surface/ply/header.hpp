// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/file/scanner.hpp>
#include <taut/impl/files/file/text_list.hpp>

namespace taut::io::impl
{

enum class ply_type
{
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    float32,
    float64
};

constexpr std::size_t size_of(ply_type t)
{
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(t)];
}

struct ply_property
{
    std::string name;
    ply_type type;                  ///< of the value, or of each item of a list
    std::optional<ply_type> counts; ///< of the length, if it is a list
};

struct ply_element
{
    std::string name;
    std::size_t rows;
    std::vector<ply_property> properties;
};

struct ply_header
{
    enum encoding
    {
        ascii,
        little,
        big
    };
    encoding format;
    std::vector<ply_element> elements; ///< in the order of the data
    text_list comments;
};

inline ply_type read_ply_type(scanner& in)
{
    constexpr std::array<std::pair<std::string_view, ply_type>, 16> names = {{{"char", ply_type::int8},
                                                                              {"uchar", ply_type::uint8},
                                                                              {"short", ply_type::int16},
                                                                              {"ushort", ply_type::uint16},
                                                                              {"int", ply_type::int32},
                                                                              {"uint", ply_type::uint32},
                                                                              {"float", ply_type::float32},
                                                                              {"double", ply_type::float64},
                                                                              {"int8", ply_type::int8},
                                                                              {"uint8", ply_type::uint8},
                                                                              {"int16", ply_type::int16},
                                                                              {"uint16", ply_type::uint16},
                                                                              {"int32", ply_type::int32},
                                                                              {"uint32", ply_type::uint32},
                                                                              {"float32", ply_type::float32},
                                                                              {"float64", ply_type::float64}}};
    const std::string_view word = in.word();
    const auto* found = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == word; });
    if (found == names.end())
        in.fail("unknown type '" + std::string(word.substr(0, 40)) +
                "'; it must be char, uchar, short, ushort, int, uint, float or double");
    return found->second;
}

inline ply_property read_ply_property(scanner& in)
{
    ply_property p{};
    const scanner before = in;
    if (in.word() == "list")
        p.counts = read_ply_type(in);
    else
        in = before;
    p.type = read_ply_type(in);
    p.name = in.word();
    return p;
}

/// Reads up to and including the line end_header. Throws io_error.
inline ply_header read_ply_header(scanner& in)
{
    if (in.word() != "ply")
        in.fail("not a PLY file: it does not start with 'ply'; name it after the format that it has");
    std::optional<ply_header::encoding> format;
    std::vector<ply_element> elements;
    std::set<std::string> names; // of elements
    text_list comments;
    for (;;)
    {
        in.next_line();
        if (in.done()) in.fail("the header has no end_header; end it with one");
        const std::string_view key = in.word();
        if (key == "format")
        {
            const std::string_view name = in.word();
            if (name == "ascii")
                format = ply_header::ascii;
            else if (name == "binary_little_endian")
                format = ply_header::little;
            else if (name == "binary_big_endian")
                format = ply_header::big;
            else
                in.fail("unknown format '" + std::string(name.substr(0, 40)) +
                        "'; it must be ascii, binary_little_endian or binary_big_endian");
        }
        else if (key == "element")
        {
            std::string name(in.word());
            const long long rows = in.integer("the number of elements");
            if (rows < 0) in.fail("a negative number of elements; count them from 0");
            if (!names.insert(name).second)
                in.fail("element " + name.substr(0, 40) + " is declared twice; join the two");
            elements.push_back({std::move(name), static_cast<std::size_t>(rows), {}});
        }
        else if (key == "property")
        {
            if (elements.empty()) in.fail("a property before the first element; put it behind the element that has it");
            elements.back().properties.push_back(read_ply_property(in));
        }
        else if (key == "end_header")
            break;
        else if (key == "comment" || key == "obj_info")
            comments.add(in.rest_of_line());
        else if (!key.empty())
            in.fail("unknown header line '" + std::string(key.substr(0, 40)) +
                    "'; write format, comment, obj_info, element, property or end_header");
    }
    in.next_line();
    if (!format) in.fail("the header has no format; add 'format ascii 1.0', or that of its data");
    return {*format, std::move(elements), std::move(comments)};
}

} // namespace taut::io::impl
