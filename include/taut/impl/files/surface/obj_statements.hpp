// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <taut/impl/files/file/scanner.hpp>

/// Splits OBJ text into statements and faces into corners, for reading and for rewriting.
namespace taut::io::impl
{

/// Returns whether a backslash at the end of its line joins the next one to a statement: to numbers, as of vertices,
/// faces and curves. What names something ends with its line, as do comments: names may end with a backslash.
inline bool joins_lines(std::string_view key)
{
    static constexpr std::array<std::string_view, 23> known = {
        "v",    "vt",   "vn",   "vp", "f",   "fo",  "l",    "p",    "curv",  "curv2", "surf",  "parm",
        "trim", "hole", "scrv", "sp", "con", "deg", "bmat", "step", "ctech", "stech", "cstype"};
    return std::find(known.begin(), known.end(), key) != known.end();
}

/// Returns whether a statement is a face: f, or fo of the format's first version, which is read as f.
inline bool is_face(std::string_view key)
{
    return !key.empty() && key[0] == 'f' && (key.size() == 1 || (key.size() == 2 && key[1] == 'o'));
}

/// Calls statement(key, begin) for each statement: its first word, behind which the scanner stands, and its first byte.
/// What the call does not read is skipped.
template <class Statement>
void for_each_statement(scanner& in, Statement statement)
{
    while (!in.done())
    {
        const char* const begin = in.position();
        const std::string_view key = in.word();
        statement(key, begin);
        in.next_line(joins_lines(key));
    }
}

/// A corner of a face: v, v/vt, v//vn or v/vt/vn.
struct obj_corner
{
    long long vertex = 0, texcoord = 0; ///< as written: from 1, or back from -1; texcoord 0: none
    const char* vertex_end = nullptr;   ///< what stands between these is "", "/" or "/vt"
    const char* texcoord_end = nullptr;
    long long normal = 0;
    bool has_texcoord = false, has_normal = false;
};

/// Reads a corner. Throws io_error.
inline obj_corner read_obj_corner(scanner& in)
{
    constexpr const char* number = "a corner such as 7, 7/7 or 7//7";
    obj_corner c;
    c.vertex = in.leading_integer(number);
    c.vertex_end = in.position();
    const bool more = in.take('/');
    c.has_texcoord = more && !in.at('/') && !in.word_ends();
    if (c.has_texcoord) c.texcoord = in.leading_integer(number);
    c.texcoord_end = in.position();
    c.has_normal = more && in.take('/') && !in.word_ends();
    if (c.has_normal) c.normal = in.leading_integer("a normal");
    if (!in.word_ends()) in.fail_at_word("a blank after the corner of a face");
    return c;
}

/// The text in pieces of about `size` bytes that end with a statement.
inline std::vector<std::string_view> cut_statements(std::string_view text, std::size_t size)
{
    std::vector<std::string_view> pieces;
    std::size_t begin = 0;
    while (text.size() - begin > size)
    {
        std::size_t end = begin + size;
        const auto joined = [&]
        {
            const std::size_t last = text[end - 1] == '\r' ? end - 2 : end - 1;
            return text[last] == '\\';
        };
        do end = text.find('\n', end + 1);
        while (end != text.npos && joined());
        if (end == text.npos) break;
        pieces.push_back(text.substr(begin, end + 1 - begin));
        begin = end + 1;
    }
    pieces.push_back(text.substr(begin));
    return pieces;
}

} // namespace taut::io::impl
